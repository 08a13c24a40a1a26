"""One text that is all mutants of a source: each is chosen at run time by its number."""

from bisect import bisect_right


class Schemata:
    """`edits` of one file, less those that do not compile."""

    def __init__(self, text, edits):
        self.text = text
        self.edits = sorted(edits, key=lambda e: (e.start, -e.end, not e.is_statement))
        self.pieces, self.length = [], 0
        self.spans = []  # (first, last, edit) in the rendered text
        self.origins = []  # (rendered, original) offsets of what was copied
        self.numbers = {}

    def render(self, first):
        """`first`: number of the first mutant here. The rest follow in the order of the text."""
        number = first
        for edit in self.edits:
            self.numbers[id(edit)] = number
            number += len(edit.mutants)
        self.put('#include "mutant.hpp"\n')
        self.words = sorted({(e.constant.at, e.constant.instead) for e in self.edits if e.constant})
        self.next_edit = 0
        self.stretch(0, len(self.text))
        return "".join(self.pieces)

    def put(self, text):
        self.pieces.append(text)
        self.length += len(text)

    def copy(self, start, end):
        while start < end:
            word = next((w for w in self.words if start <= w[0] < end), None)
            stop = word[0] if word else end
            self.origins.append((self.length, start))
            self.put(self.text[start:stop])
            start = stop
            if word:
                self.put(word[1])
                start += len("constexpr")

    def stretch(self, start, end):
        while self.next_edit < len(self.edits) and self.edits[self.next_edit].start < end:
            edit = self.edits[self.next_edit]
            self.next_edit += 1
            if edit.end > end:
                raise ValueError(f"edits cross at offset {edit.start}")
            self.copy(start, edit.start)
            self.one(edit)
            start = edit.end
        self.copy(start, end)

    def one(self, edit):
        if not edit.mutants:
            return
        first, number = self.length, self.numbers[id(edit)]
        if edit.is_statement:
            self.put(f"{{ if (!is_mutant({number})) {{ ")
            self.stretch(edit.start, edit.end)
            self.put(" } }")
        else:
            self.put("(")
            for i, (_, replacement) in enumerate(edit.mutants):
                self.put(f"is_mutant({number + i}) ? ({replacement}) : ")
            self.put("static_cast<bool>(" if edit.is_condition else "(")
            self.stretch(edit.start, edit.end)
            self.put("))")
        self.spans.append((first, self.length, edit))

    def innermost(self, offset):
        around = [span for span in self.spans if span[0] <= offset < span[1]]
        return min(around, key=lambda span: span[1] - span[0])[2] if around else None

    def original(self, offset):
        at = bisect_right(self.origins, (offset, len(self.text))) - 1
        return self.origins[at][1] + offset - self.origins[at][0] if at >= 0 else 0
