"""The rules: what can be wrong at each point of a source where it decides."""

import re
from dataclasses import dataclass, field

from clang.cindex import CursorKind as Kind
from clang.cindex import StorageClass, TypeKind

COMPARISONS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="}
ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "/", "<<": ">>", ">>": "<<", "&": "|", "|": "&", "^": "|"}
LOGIC = {"&&": "||", "||": "&&"}
ASSIGNMENTS = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "|=": "&=", "&=": "|=", "^=": "|=", "<<=": ">>=", ">>=": "<<="}

INTEGERS = {TypeKind.CHAR_S, TypeKind.CHAR_U, TypeKind.SCHAR, TypeKind.UCHAR, TypeKind.SHORT, TypeKind.USHORT, TypeKind.INT,
            TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.LONGLONG, TypeKind.ULONGLONG}
NUMBERS = INTEGERS | {TypeKind.FLOAT, TypeKind.DOUBLE}

FUNCTIONS = {Kind.FUNCTION_DECL, Kind.CXX_METHOD, Kind.CONSTRUCTOR, Kind.DESTRUCTOR, Kind.CONVERSION_FUNCTION, Kind.FUNCTION_TEMPLATE}
NEVER = {Kind.STATIC_ASSERT, Kind.ENUM_DECL, Kind.PARM_DECL, Kind.TEMPLATE_NON_TYPE_PARAMETER, Kind.TYPE_REF, Kind.TEMPLATE_REF,
         Kind.NAMESPACE_REF, Kind.TYPE_ALIAS_DECL, Kind.USING_DECLARATION, Kind.FRIEND_DECL}


@dataclass(frozen=True)
class Constant:
    """What is constexpr: a compiler would settle it before any mutant can be chosen."""
    at: int  # where the word stands
    instead: str


@dataclass
class Edit:
    """A stretch of the text, and what may stand there instead. All offsets are of the text."""
    start: int
    end: int
    is_statement: bool = False
    mutants: list = field(default_factory=list)  # (rule, replacement); of a statement: (rule, "")
    function: str = ""
    is_condition: bool = False
    once: bool = False  # evaluated once in the life of the program, not by each case
    constant: "Constant" = None  # that must become a variable


def kind_of(cursor):
    return cursor.type.get_canonical().kind


def inside(cursor):
    """What implicit conversions and parentheses are wrapped around."""
    while cursor.kind in (Kind.UNEXPOSED_EXPR, Kind.PAREN_EXPR):
        children = list(cursor.get_children())
        if len(children) != 1:
            return cursor
        cursor = children[0]
    return cursor


class Rules:
    def __init__(self, text, is_header=False):
        self.text, self.is_header = text, is_header
        self.edits = {}
        self.function, self.once, self.constant = "", False, None

    def of(self, cursor):
        extent = cursor.extent
        return self.text[extent.start.offset:extent.end.offset]

    def add(self, start, end, rule, replacement, is_statement=False):
        key = (start, end, is_statement)
        edit = self.edits.setdefault(
            key, Edit(start, end, is_statement, [], self.function, False, self.once, self.constant))
        edit.is_condition |= rule in ("never", "always")
        if replacement not in [other for _, other in edit.mutants]:
            edit.mutants.append((rule, replacement))

    def at(self, cursor, rule, replacement):
        self.add(cursor.extent.start.offset, cursor.extent.end.offset, rule, replacement)

    def visit(self, cursor):
        if cursor.kind in NEVER:
            return
        if cursor.kind in FUNCTIONS:
            return self.visit_function(cursor)
        if cursor.kind in (Kind.VAR_DECL, Kind.FIELD_DECL):
            return self.visit_variable(cursor)
        if cursor.kind == Kind.CASE_STMT:
            return [self.visit_body(child) for child in list(cursor.get_children())[1:]]
        if cursor.kind in (Kind.CXX_FOR_RANGE_STMT, Kind.DEFAULT_STMT, Kind.LABEL_STMT):
            children = list(cursor.get_children())
            [self.visit(child) for child in children[:-1]]
            return self.visit_body(children[-1])
        rule = getattr(self, "on_" + cursor.kind.name.lower(), None)
        if rule:
            rule(cursor)
        if cursor.kind not in (Kind.IF_STMT, Kind.WHILE_STMT, Kind.FOR_STMT, Kind.COMPOUND_STMT):
            for child in cursor.get_children():
                self.visit(child)

    def visit_function(self, cursor):
        children = [c for c in cursor.get_children() if c.kind not in NEVER]
        if not cursor.is_definition() or not any(c.kind == Kind.COMPOUND_STMT for c in children):
            return
        before = self.function, self.constant
        self.function = cursor.spelling
        self.constant = self.constexpr_of(cursor) or self.constant
        for child in children:
            if child.extent.start.offset > cursor.location.offset:
                self.visit(child)
        self.function, self.constant = before

    def visit_variable(self, cursor):
        """Its initialiser: what stands behind its name and the size of an array."""
        if self.is_header and kind_of(cursor) in INTEGERS and self.constexpr_of(cursor):
            return  # on_decl_ref_expr: others make cases and sizes of it
        before = self.once, self.constant
        local = cursor.semantic_parent.kind in FUNCTIONS
        self.constant = self.constexpr_of(cursor) or self.constant
        self.once = self.once or (cursor.kind == Kind.VAR_DECL and
                                  (not local or cursor.storage_class == StorageClass.STATIC))
        if self.constant and self.once and kind_of(cursor) == TypeKind.RECORD:  # others may be made of it
            at = cursor.location.offset
            self.edits[at, at, False] = Edit(at, at, constant=self.constant)
        initialiser = re.compile(r"[={(]").search(self.text, cursor.location.offset)
        for child in cursor.get_children():
            if initialiser and child.extent.start.offset >= initialiser.start():
                if self.is_plain_bool(child):
                    self.at(child, "negated", f"!({self.of(child)})")
                self.visit(child)
        self.once, self.constant = before

    def constexpr_of(self, cursor):
        """The word stands before the name; of several declarators it stands before the first."""
        start = max(self.text.rfind(end, 0, cursor.extent.start.offset) for end in ";{}>)\n") + 1
        found = list(re.finditer(r"\bconstexpr\b", self.text[start:cursor.location.offset]))
        if not found:
            return None
        word = start + found[-1].start()
        before = self.text[start:word]
        if cursor.kind in FUNCTIONS:
            return Constant(word, "" if "inline" in before else "inline")
        member = cursor.semantic_parent.kind in (Kind.CLASS_DECL, Kind.STRUCT_DECL)
        return Constant(word, "inline const" if member and "inline" not in before else "const")

    # Statements

    def visit_body(self, cursor, last=False):
        """A statement that may be dropped."""
        inner = inside(cursor)
        drops = (Kind.CALL_EXPR, Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR, Kind.UNARY_OPERATOR)
        leaves = (Kind.RETURN_STMT, Kind.CONTINUE_STMT)
        end = self.text.find(";", cursor.extent.end.offset)
        whole = end >= 0 and not self.text[cursor.extent.end.offset:end].strip()
        if whole and ((inner.kind in drops and kind_of(inner) != TypeKind.INVALID) or (inner.kind in leaves and not last)):
            self.add(cursor.extent.start.offset, end + 1, "dropped", "", True)
        self.visit(cursor)

    def on_compound_stmt(self, cursor):
        children = list(cursor.get_children())
        for child in children:
            self.visit_body(child, child == children[-1])

    def on_for_stmt(self, cursor):
        children = list(cursor.get_children())
        for child in children[:-1]:
            self.visit(child)
        self.visit_body(children[-1])

    def closing(self, at):
        """The parenthesis that closes the first one behind `at`."""
        at = self.text.index("(", at)
        depth = 0
        for i in range(at, len(self.text)):
            depth += {"(": 1, ")": -1}.get(self.text[i], 0)
            if depth == 0:
                return i
        return len(self.text)

    def on_if_stmt(self, cursor):
        begin = cursor.extent.start.offset
        close = self.closing(begin)
        children = list(cursor.get_children())
        heads = [c for c in children if c.extent.start.offset < close]
        loop = cursor.kind == Kind.WHILE_STMT
        fixed = self.text[begin:].startswith("if constexpr")
        for head in heads:
            declares = head.kind in (Kind.DECL_STMT, Kind.VAR_DECL)
            if head == heads[-1] and not declares and not fixed and not any(c.kind == Kind.VAR_DECL for c in heads):
                self.at(head, "never", "false")
                if not loop:
                    self.at(head, "always", "true")
                self.visit_condition(head)
            else:
                self.visit(head)
        for child in children[len(heads):]:
            self.visit_body(child)

    on_while_stmt = on_if_stmt

    def visit_condition(self, cursor):
        """Never and always are worse than the opposite."""
        inner = inside(cursor)
        if inner.kind == Kind.UNARY_OPERATOR and self.of(inner).startswith("!"):
            return [self.visit(child) for child in inner.get_children()]
        if inner.kind == Kind.BINARY_OPERATOR and self.operator(inner) in ("==", "!="):
            return [self.visit(child) for child in inner.get_children()]
        self.visit(cursor)

    def on_return_stmt(self, cursor):
        for child in cursor.get_children():
            if self.is_plain_bool(child):
                self.at(child, "negated", f"!({self.of(child)})")

    def is_plain_bool(self, cursor):
        """A truth value that no other rule turns round."""
        inner = inside(cursor)
        return inner.kind in (Kind.CALL_EXPR, Kind.DECL_REF_EXPR, Kind.MEMBER_REF_EXPR) and \
            kind_of(inner) == TypeKind.BOOL and not self.operator(inner) in COMPARISONS

    def on_switch_stmt(self, cursor):
        """The case of one value is that of the next."""
        subject, body = list(cursor.get_children())[-2:]
        labels = []
        for one in body.get_children():
            while one.kind == Kind.CASE_STMT:
                label, one = list(one.get_children())[:2]
                labels.append(self.of(label))
        text = self.of(subject)
        for label, other in zip(labels, labels[1:] + labels[:1]):
            if other != label:
                self.at(subject, "case", f"({text}) == {label} ? {other} : ({text})")

    # Expressions

    def operator(self, cursor):
        """The operator between two operands, else nothing."""
        children = list(cursor.get_children())
        if cursor.kind == Kind.CALL_EXPR and (len(children) != 3 or not cursor.spelling.startswith("operator")):
            return ""
        if len(children) < 2:
            return ""
        return self.text[children[0].extent.end.offset:children[-1].extent.start.offset].strip()

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
