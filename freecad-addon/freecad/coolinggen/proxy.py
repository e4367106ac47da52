"""What the Python halves of document objects and views have in common."""


class Proxy:
    """Keeps nothing in the file: all that is worth keeping is in properties.

    FreeCAD asks by either pair of names.
    """

    def dumps(self):
        return None

    def loads(self, state) -> None:
        pass

    def __getstate__(self):
        return None

    def __setstate__(self, state) -> None:
        pass
