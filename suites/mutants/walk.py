"""Goes through a source and finds the points where it decides: its conditions, statements and initialisers."""

import re
from dataclasses import dataclass, field

from clang.cindex import CursorKind as Kind
from clang.cindex import StorageClass, TypeKind

INTEGERS = {TypeKind.CHAR_S, TypeKind.CHAR_U, TypeKind.SCHAR, TypeKind.UCHAR, TypeKind.SHORT, TypeKind.USHORT, TypeKind.INT,
            TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.LONGLONG, TypeKind.ULONGLONG}
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


class Walk:
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
        if cursor.kind in NEVER or self.only_saves_time(cursor):
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

    @staticmethod
    def only_saves_time(cursor):
        """No device can be told from another by it."""
        return cursor.kind == Kind.CALL_EXPR and cursor.spelling == "reserve"

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
        if self.only_saves_time(inner):
            return
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

    def refuses_set_up(self, cursor):
        """An `if` that returns an Error alone: what is told to run so in words is no device yet."""
        begin, close = cursor.extent.start.offset, self.closing(cursor.extent.start.offset)
        head, body = self.text[begin:close], self.text[close + 1:cursor.extent.end.offset].strip(" \n{};")
        named = re.search(r"\bStatus (\w+) =", head)
        return re.match(r"return (fail|wrong)\(", body) or re.fullmatch(r"return \*?[\w.>()-]*error\(\)", body) or \
            (named and body == f"return {named[1]}")

    def on_if_stmt(self, cursor):
        if self.refuses_set_up(cursor):
            return
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
            kind_of(inner) == TypeKind.BOOL and not self.operator(inner)

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

    def operator(self, cursor):
        """The operator between two operands, else nothing."""
        children = list(cursor.get_children())
        if cursor.kind == Kind.CALL_EXPR and (len(children) != 3 or not cursor.spelling.startswith("operator")):
            return ""
        if len(children) < 2:
            return ""
        return self.text[children[0].extent.end.offset:children[-1].extent.start.offset].strip()
