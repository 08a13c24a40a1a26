"""Single faults as lines of text, one of which is at work."""


class FaultTable:
    def __init__(self, text, groups):
        """`text`: name | group of protocols | one sentence, a fault a line."""
        self.all, self.active = {}, None
        for line in text.strip().splitlines():
            name, group, sentence = (part.strip() for part in line.split('|'))
            assert name not in self.all, name
            self.all[name] = (groups[group], sentence)

    def choose(self, name):
        assert name is None or name in self.all, name
        self.active = name

    def fault(self, name):
        assert name in self.all, name
        return self.active == name
