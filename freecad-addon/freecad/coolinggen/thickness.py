"""Wall thickness as colours."""


def paint(obj) -> None:
    """Colours a blade's faces by the metal between them and the outer surface."""
    raise NotImplementedError
