#!/usr/bin/python3
"""Writes src/ with all its mutants, and the table of them.

generate.py PROJECT OUT: OUT/src is the mutated copy, OUT/mutants.json the table, OUT/stamp the time.
"""

import json
import re
import shutil
import sys
import time
from pathlib import Path

from clang.cindex import Config, CursorKind, Diagnostic, Index

from rules import Rules
from schemata import Schemata
from sources import is_device, protocol_of

FLAGS = ["-x", "c++", "-std=c++20", "-ferror-limit=0", "-Werror=vla-extension", "-Werror=vla", "-Werror=return-type",
         "-Wno-c++11-narrowing", "-Wno-pragma-once-outside-header"]


def use_library():
    found = sorted(Path("/usr/lib").glob("llvm-*/lib/libclang*.so*"))
    if not Config.library_file and found:
        Config.set_library_file(str(found[-1]))


def parsed(files, roots):
    """All files of a room in one piece: their headers are parsed once."""
    text = "".join(f'#include "{file}"\n' for file in files)
    flags = [*FLAGS, *[part for root in roots for part in ("-I", str(root))]]
    name = str(roots[0] / "room.cpp")
    return Index.create().parse(name, flags, unsaved_files=[(name, text)])


class Source:
    """A file, its edits, and the text that has them all."""

    def __init__(self, project, path):
        self.path = path
        self.text = (project / path).read_bytes().decode("latin-1")  # a character a byte, as offsets are
        self.rules, self.edits = Rules(self.text, path.endswith(".hpp")), []

    def collect(self, cursor):
        """`cursor`: a declaration of this file."""
        if cursor.kind == CursorKind.NAMESPACE:
            for child in cursor.get_children():
                self.collect(child)
        else:
            self.rules.visit(cursor)
        self.edits = list(self.rules.edits.values())

    def render(self, first):
        self.schemata = Schemata(self.text, self.edits)
        return self.schemata.render(first)

    def count(self):
        return sum(len(edit.mutants) for edit in self.edits)

    def drop(self, dropped):
        self.edits = [edit for edit in self.edits if not dropped(edit)]

    def position(self, offset):
        line = self.text.count("\n", 0, offset) + 1
        return line, offset - self.text.rfind("\n", 0, offset)

    def rows(self, first):
        """What the table says of each mutant, in their order."""
        number = first
        for edit in self.schemata.edits:
            before = self.text[edit.start:edit.end]
            line, column = self.position(edit.start)
            for rule, after in edit.mutants:
                yield {"id": number, "protocol": protocol_of(self.path), "file": self.path, "line": line,
                       "column": column, "function": edit.function, "rule": rule, "before": before, "after": after,
                       "once": edit.once}
                number += 1


class Trouble:
    """What a compiler says of a mutated file, and all places that it names: file and offset."""

    def __init__(self, diagnostic):
        self.text = str(diagnostic)
        self.places = [(d.location.file.name if d.location.file else "", d.location.offset)
                       for d in [diagnostic, *diagnostic.children]]


class Generator:
    def __init__(self, project, out, paths):
        self.project, self.out = project, out
        self.sources = {path: Source(project, path) for path in paths}
        self.rooms = {}
        for path in paths:
            self.rooms.setdefault(str(Path(path).parent), []).append(path)
        for room, files in self.rooms.items():
            unit = parsed(files, [project])
            errors = [d for d in unit.diagnostics if d.severity >= Diagnostic.Error]
            if errors:
                sys.exit(f"cannot mutate {room}: {errors[0]}; does it compile?")
            named = {str(project / file): self.sources[file] for file in files}
            for cursor in unit.cursor.get_children():
                source = named.get(cursor.location.file.name) if cursor.location.file else None
                if source:
                    source.collect(cursor)

    def write(self):
        """Numbers all mutants anew."""
        number = 1
        for path, source in self.sources.items():
            text = source.render(number)
            number += source.count()
            (self.out / path).parent.mkdir(parents=True, exist_ok=True)
            (self.out / path).write_bytes(text.encode("latin-1"))

    def compile(self, room):
        unit = parsed(self.rooms[room], [self.out, self.project, Path(__file__).parent])
        return [Trouble(d) for d in unit.diagnostics if d.severity >= Diagnostic.Error]

    def source_of(self, name):
        """`name`: of a mutated file."""
        path = Path(name)
        return self.sources.get(str(path.relative_to(self.out))) if path.is_relative_to(self.out) else None

    def forget(self, trouble):
        """Drops what an error is about: the edit there, and constants that must stay constants."""
        source = self.source_of(trouble.places[0][0])
        edit = source.schemata.innermost(trouble.places[0][1]) if source else None
        if edit and not edit.constant:
            source.drop(lambda e: e is edit)
            return True
        if source and "does not return a value" in trouble.text:
            return self.forget_returns(source, trouble.places[0][1])
        done = False
        for name, offset in trouble.places:
            source = self.source_of(name)
            if not source:
                continue
            edit = source.schemata.innermost(offset)
            line = source.position(source.schemata.original(offset))[0]
            before = source.count()
            source.drop(lambda e: (e is edit and not e.constant) or e.constant and (edit and e.constant == edit.constant or
                                                  source.position(e.constant.at)[0] <= line <= source.position(e.end)[0]))
            done |= source.count() < before
        return done

    @staticmethod
    def forget_returns(source, end):
        """Drops the dropped returns of the function that ends there."""
        returns = [(last, edit) for _, last, edit in source.schemata.spans
                   if edit.is_statement and source.text.startswith("return", edit.start) and last <= end]
        function = max(returns, key=lambda span: span[0])[1].function
        source.drop(lambda e: e.is_statement and e.function == function and source.text.startswith("return", e.start))
        return True

    def count(self):
        return sum(source.count() for source in self.sources.values())

    def run(self):
        """Writes, compiles and drops until all compiles. What is dropped in one room breaks no other."""
        generated = self.count()
        rooms = list(self.rooms)
        while rooms:
            self.write()
            before = self.count()
            troubles = {room: self.compile(room) for room in rooms}
            rooms = [room for room in rooms if troubles[room]]
            for trouble in sum(troubles.values(), []):
                self.forget(trouble)
            if rooms and before == self.count():
                sys.exit(f"no mutant explains: {troubles[rooms[0]][0].text}")
            print(f"{before} mutants, {len(rooms)} rooms with errors, {time.process_time():.0f} s", flush=True)
        print(f"{self.count()} mutants in {len(self.sources)} files; {generated - self.count()} more do not compile")

    def table(self):
        rows = []
        for source in self.sources.values():
            rows.extend(source.rows(len(rows) + 1))
        return rows


def main():
    use_library()
    project, out = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    only = sys.argv[3:]
    shutil.rmtree(out / "src", ignore_errors=True)
    paths = sorted(str(p.relative_to(project)) for p in (project / "src").glob("*/*.?pp"))
    for path in paths:
        (out / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(project / path, out / path)
    paths = [p for p in paths if is_device(p) and (not only or p in only)]
    generator = Generator(project, out, sorted(paths, key=lambda p: (not p.endswith(".hpp"), p)))
    generator.run()
    (out / "mutants.json").write_text("[\n" + ",\n".join(json.dumps(row) for row in generator.table()) + "\n]\n")


if __name__ == "__main__":
    main()
