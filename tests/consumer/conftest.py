"""Fixtures: every sample is generated once a session; the outside programs look at them beside the tests."""

from __future__ import annotations

from pathlib import Path

import pytest

import cli
import occ
import witness


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "sample" in metafunc.fixturenames:
        samples = cli.samples()
        if not samples:
            raise pytest.UsageError(f"no samples in {cli.SAMPLES}")
        metafunc.parametrize("sample", samples, ids=[path.stem for path in samples], scope="session")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """What waits for outside programs comes last, FreeCAD's minutes behind Gmsh's."""
    waits = {"test_gmsh": 1, "test_freecad": 2}
    items.sort(key=lambda item: waits.get(item.path.stem, 0))


@pytest.fixture(scope="session", autouse=True)
def witnesses(request: pytest.FixtureRequest) -> None:
    """Starts FreeCAD before anything else if a test asks for it."""
    if any("freecad" in getattr(item, "fixturenames", ()) for item in request.session.items):
        request.getfixturevalue("freecad")


class Library:
    """The generated models and what OpenCASCADE read of them, each made on first use."""

    def __init__(self, folder: Path):
        self.folder = folder
        self._models: dict[Path, cli.Model | Exception] = {}
        self._products: dict[Path, list[occ.Product]] = {}

    def model(self, design: Path) -> cli.Model:
        if design not in self._models:
            try:
                self._models[design] = cli.build(design, self.folder / design.stem)
            except Exception as error:  # remembered, so that a failing sample is run only once
                self._models[design] = error
        found = self._models[design]
        if isinstance(found, Exception):
            pytest.fail(str(found), pytrace=False)
        return found

    def built(self, designs: list[Path]) -> list[cli.Model]:
        """The models among these designs that could be generated."""
        for design in designs:
            try:
                self.model(design)
            except pytest.fail.Exception:
                continue
        return [m for d in designs if isinstance(m := self._models[d], cli.Model)]

    def products(self, step: Path) -> list[occ.Product]:
        if step not in self._products:
            self._products[step] = occ.read(step)
        return self._products[step]


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    if not cli.BINARY.is_file():
        pytest.exit(f"{cli.BINARY} is missing: build it (cargo build --release) or set COOLINGGEN", 1)
    return Library(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="session")
def model(library: Library, sample: Path) -> cli.Model:
    return library.model(sample)


@pytest.fixture(scope="session")
def selected(request: pytest.FixtureRequest, library: Library) -> list[cli.Model]:
    """The models of the samples that this session tests: those of `-k rotor` alone, for instance."""
    params = (item.callspec.params for item in request.session.items if hasattr(item, "callspec"))
    wanted = {p["sample"] for p in params if "sample" in p}
    return library.built(sorted(wanted))


@pytest.fixture(scope="session")
def freecad(selected: list[cli.Model], tmp_path_factory: pytest.TempPathFactory) -> witness.Findings:
    steps = [m.file(s, "step") for m in selected for s in (*m.parts, "assembly")]
    return witness.freecad(steps, tmp_path_factory.mktemp("freecad"))


@pytest.fixture(scope="session")
def gmsh(selected: list[cli.Model], tmp_path_factory: pytest.TempPathFactory) -> witness.Findings:
    steps = [m.file(s, "step") for m in selected for s in m.parts]
    return witness.gmsh(steps, tmp_path_factory.mktemp("gmsh"))
