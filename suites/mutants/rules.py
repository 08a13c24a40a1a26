"""The rules: what can be wrong at a point where a source decides. (Of statements and conditions: walk.py.)"""

import re

from clang.cindex import CursorKind as Kind
from clang.cindex import TypeKind

from walk import INTEGERS, Walk, kind_of

COMPARISONS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="}
ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "/", "<<": ">>", ">>": "<<", "&": "|", "|": "&", "^": "|"}
LOGIC = {"&&": "||", "||": "&&"}
ASSIGNMENTS = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "|=": "&=", "&=": "|=", "^=": "|=", "<<=": ">>=", ">>=": "<<="}

NUMBERS = INTEGERS | {TypeKind.FLOAT, TypeKind.DOUBLE}


class Rules(Walk):
    # Expressions

    def on_binary_operator(self, cursor):
        left, right = list(cursor.get_children())
        operator = self.operator(cursor)
        a, b = self.of(left), self.of(right)
        if operator in COMPARISONS:
            self.at(cursor, "comparison", f"({a}) {COMPARISONS[operator]} ({b})")
        elif operator in LOGIC:
            self.at(cursor, "logic", f"({a}) {LOGIC[operator]} ({b})")
            self.at(cursor, "operand dropped", f"static_cast<bool>({a})")
            self.at(cursor, "operand dropped", f"static_cast<bool>({b})")
        elif operator in ARITHMETIC and kind_of(left) in NUMBERS and kind_of(right) in NUMBERS:
            self.at(cursor, "arithmetic", f"({a}) {ARITHMETIC[operator]} ({b})")

    def on_call_expr(self, cursor):
        children = list(cursor.get_children())
        operator = self.operator(cursor)
        if operator in COMPARISONS:
            self.at(cursor, "comparison", f"({self.of(children[0])}) {COMPARISONS[operator]} ({self.of(children[-1])})")
        elif operator in ("+", "-") and cursor.spelling in ("operator+", "operator-") and kind_of(children[-1]) in NUMBERS:
            self.at(cursor, "arithmetic", f"({self.of(children[0])}) {ARITHMETIC[operator]} ({self.of(children[-1])})")
        text = self.of(cursor)
        for name, other in (("std::min", "std::max"), ("std::max", "std::min")):
            if text.startswith(name + "(") or text.startswith(name + "<"):
                self.at(cursor, "least and most", other + text[len(name):])

    def on_compound_assignment_operator(self, cursor):
        left, right = list(cursor.get_children())
        operator = self.operator(cursor)
        if operator in ASSIGNMENTS and kind_of(left) in NUMBERS and kind_of(right) in NUMBERS:
            self.at(cursor, "arithmetic", f"{self.of(left)} {ASSIGNMENTS[operator]} {self.of(right)}")

    def on_unary_operator(self, cursor):
        text = self.of(cursor)
        operand = self.of(list(cursor.get_children())[0])
        if text[:1] in ("!", "~") or (text[:1] == "-" and text[:2] != "--"):
            self.at(cursor, "sign dropped", f"static_cast<bool>({operand})" if text[0] == "!" else f"({operand})")

    def on_conditional_operator(self, cursor):
        condition, yes, no = list(cursor.get_children())
        self.at(condition, "never", "false")
        self.at(condition, "always", "true")

    # Constants

    def on_integer_literal(self, cursor):
        text = self.of(cursor)
        if re.fullmatch(r"[0-9a-fA-FxXbB']+[uUlLzZ]*", text):
            self.at(cursor, "constant", f"{text} + 1")
            if text.rstrip("uUlLzZ") not in ("0", "0x0", "0x00", "0x0000"):
                self.at(cursor, "constant", f"{text} - 1")
        elif timed := re.fullmatch(r"[0-9']+(h|min|s|ms|us|ns)", text):
            self.at(cursor, "constant", f"{text} + 1{timed[1]}")
            if not text.startswith("0"):
                self.at(cursor, "constant", f"{text} - 1{timed[1]}")

    def on_floating_literal(self, cursor):
        text = self.of(cursor)
        if re.fullmatch(r"[0-9.eE'+-]+", text):
            self.at(cursor, "constant", f"{text} + 1")

    def on_character_literal(self, cursor):
        text = self.of(cursor)
        if text.startswith("'"):
            self.at(cursor, "constant", f"static_cast<char>({text} + 1)")

    def on_cxx_bool_literal_expr(self, cursor):
        text = self.of(cursor)
        if text in ("true", "false"):
            self.at(cursor, "constant", "false" if text == "true" else "true")

    def on_string_literal(self, cursor):
        """What a protocol says; not what people read."""
        text = self.of(cursor)
        if re.fullmatch(r'"[^"\\]*[^"\\a-z ]"', text) and not re.search(r"[a-z]{2}| [a-z]", text):
            last = chr(ord(text[-2]) + 1)
            if last not in '"\\' and ord(last) < 127:
                self.at(cursor, "constant", text[:-2] + last + '"')

    def on_decl_ref_expr(self, cursor):
        known = cursor.referenced
        if known is None:
            return
        text = self.of(cursor)
        if known.kind == Kind.ENUM_CONSTANT_DECL:
            names = [c.spelling for c in known.semantic_parent.get_children() if c.kind == Kind.ENUM_CONSTANT_DECL]
            other = names[(names.index(known.spelling) + 1) % len(names)]
            if other != known.spelling and text.endswith(known.spelling):
                self.at(cursor, "constant", text[:-len(known.spelling)] + other)
        elif known.kind == Kind.VAR_DECL and known.type.is_const_qualified() and kind_of(known) in INTEGERS and \
                known.location.file and known.location.file.name.endswith(".hpp"):
            self.at(cursor, "constant", f"static_cast<std::remove_const_t<decltype({text})>>({text} + 1)")
