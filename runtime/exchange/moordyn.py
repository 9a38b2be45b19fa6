"""Scenes from input files of MoorDyn-2: lines become cables, points their supports, ties and point masses."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..base.deferred import dataclass
from ..base.rotations import product, rotate, turned_by
from ..errors import SceneError
from ..parts.material import Material
from ..parts.section import GeneralSection
from ..parts.surface_shapes import Plane
from ..parts.validation import show, shown
from ..scene.scene import Scene
from .moordyn_file import MoorDynFile, Row, named, read_file
from .moordyn_laws import AxialLaw
from .moordyn_syrope import Loaded

DEFAULTS = {"g": 9.80665, "rhow": 1025.0, "wtrdpth": 0.0, "kbot": 3e6, "cbot": 3e5, "frictioncoefficient": 0.0}
"""Options by their names in small letters, with MoorDyn's defaults."""
SYNONYMS = {"gravity": "g", "rho": "rhow", "wtrdens": "rhow", "wtrdnsty": "rhow", "kb": "kbot", "cb": "cbot",
            "depth": "wtrdpth", "wdepth": "wtrdpth", "frictioncoeff": "frictioncoefficient",
            "icfile": "fileic"}
LEFT_OUT = {"wavekin": "waves are left out: give the fluid `waves`",
            "currents": "currents are left out: give the fluid a velocity",
            "seafloorfile": "the sea floor is even here: in the place of the bed give a `HeightField`",
            "fileic": "the state of the file is left out: the run begins at rest"}
"""What notes say of options that are not read, unless they are 0."""
NUMERICAL = ("dtm", "dt", "cfl", "writelog", "tscheme", "dtic", "icdt", "tmaxic", "ictmax", "cdscaleic", "icdfac",
             "threshic", "icthresh", "icgendynamic", "gendynamicic", "dtwave", "unifycurrentgrid", "writeunits",
             "dtout", "disableoutput", "disableouttime", "fricdamp", "statdynfricscale")
"""Options of MoorDyn's own integration and output, and of how it regularises friction."""
ATTACHMENTS = (dict.fromkeys(("FIXED", "FIX", "ANCHOR"), "held")
               | dict.fromkeys(("COUPLED", "CPLD", "VESSEL", "VES", "FAIRLEAD"), "moved")
               | dict.fromkeys(("FREE", "POINT", "CONNECT", "CON"), "free"))
"""How a point or a body is held, by the words of its attachment: held, moved by the host program, or free."""
PINNED = dict.fromkeys(("COUPLEDPINNED", "CPLDPIN", "VESSELPINNED", "VESPIN"), "pinned")
"""Of bodies alone: the place is moved by the host program, and the body turns freely."""
TURNING = ("free", "pinned")
"""How bodies are held that turn."""
NO_DIAMETER = 1e-3
"""m: of the section of a line whose diameter is 0, without buoyancy; its stiffness EA and mass stay."""
DURATION = 60.0
"""s, of a run of the scene written; the host program of MoorDyn decides on it."""
BED_RADIUS = 1e-6
"""m: MoorDyn's bed acts on the centreline."""


@dataclass(frozen=True)
class LineType:
    """A line type, in the units of its columns."""

    row: Row
    diameter: float
    mass: float
    axial: AxialLaw
    EI: float
    drag: tuple[float, float]
    added: tuple[float, float]

    @classmethod
    def of(cls, row: Row, folder: Path) -> LineType:
        """Return the type of a line of the table; folder: that of the file. Raises SceneError."""
        diameter, mass, EI = (row.number(k, what) for k, what in ((1, "Diam"), (2, "Mass/m"), (5, "EI")))
        Cd, Ca, Cdt, Cat = (row.number(k, what, 0.0) for k, what in enumerate(("Cd", "Ca", "CdAx", "CaAx"), start=6))
        for what, value, least in (("Diam", diameter, 0.0), ("EI", EI, 0.0), ("Cd", Cd, 0.0), ("Ca", Ca, 0.0),
                                   ("CdAx", Cdt, 0.0), ("CaAx", Cat, 0.0)):
            if value < least:
                raise row.refused(f"{what} must not be negative, got {show(value)}")
        if not mass > 0:
            raise row.refused(f"Mass/m must be positive, got {show(mass)}")
        return cls(row, diameter, mass, AxialLaw.of(row, folder), EI, (Cd, Cdt), (Ca, Cat))

    @property
    def area(self) -> float:
        """Return the area of its section, m²."""
        return math.pi / 4 * (self.diameter or NO_DIAMETER) ** 2

    def section(self) -> GeneralSection:
        """Return its section, with which the material has its stiffness."""
        return GeneralSection(area=self.area, second_moment_about_z=self.EI * self.area / self.axial.EA,
                              tension_table=self.axial.table)

    @property
    def membrane(self) -> str:
        """Return the representation of axial strain: a line of MoorDyn does not push."""
        return "tabulated" if self.axial.table else "full" if self.axial.spring else "tension_only"

    def material(self, segment: float) -> Material:
        """Return its material; segment: length of a segment, m, on which a damping ratio, -BA, depends."""
        EA, BA = self.axial.EA, self.axial.damping
        BA = BA if BA >= 0 else -BA * segment * math.sqrt(EA * self.mass)
        return Material(youngs_modulus=EA / self.area, poisson_ratio=0.0, density=self.mass / self.area,
                        damping_time=BA / EA)


@dataclass(frozen=True)
class Point:
    """A point: how it is held ("held", "moved", "free"), and its place at the start, m."""

    row: Row
    how: str
    place: np.ndarray
    body: str | None
    mass: float
    volume: float
    drag: float
    added: float
    force: tuple[float, ...]

    @classmethod
    def of(cls, row: Row, bodies: dict[str, Body]) -> Point:
        """Return the point of a line of the table. Raises SceneError."""
        word = row.word(1, "Attachment").upper()
        place = np.array([row.number(k, "XYZ"[k - 2]) for k in (2, 3, 4)])
        M, V = row.number(5, "M", 0.0), row.number(6, "V", 0.0)
        at = 10 if len(row.words) >= 12 else 7
        force = tuple(row.number(k, "F") for k in (7, 8, 9)) if at == 10 else (0.0, 0.0, 0.0)
        drag, added = row.number(at, "CdA", 0.0), row.number(at + 1, "Ca", 0.0)
        body = word.removeprefix("BODY") if word.startswith("BODY") else None
        if body is not None:
            of = named(bodies, body, row, "body")
            return cls(row, of.how, of.place + of.axes @ place, body if of.how in TURNING else None, M, V, drag,
                       added, force)
        if word not in ATTACHMENTS:
            raise row.refused(f"the attachment {shown(row.words[1])} is not read", "known: Fixed, Coupled, Free, Body#")
        return cls(row, ATTACHMENTS[word], place, None, M, V, drag, added, force)


@dataclass(frozen=True)
class Body:
    """A body: how it is held, as a `Point` or "pinned"; place in m, and orientation (4,), a unit quaternion."""

    row: Row
    how: str
    place: np.ndarray
    orientation: np.ndarray

    @property
    def axes(self) -> np.ndarray:
        """Return its axes (3, 3), as columns."""
        return rotate(self.orientation, np.eye(3)).T

    @classmethod
    def of(cls, row: Row) -> Body:
        """Return the body of a line of the table. Raises SceneError."""
        word = row.word(1, "Attachment").upper()
        holds = ATTACHMENTS | PINNED
        if word not in holds:
            raise row.refused(f"the attachment {shown(row.words[1])} is not read",
                              "known: Fixed, Coupled, CoupledPinned, Free")
        place = np.array([row.number(k, ("X0", "Y0", "Z0")[k - 2]) for k in (2, 3, 4)])
        roll, pitch, yaw = (math.radians(row.number(k, ("r0", "p0", "y0")[k - 5])) for k in (5, 6, 7))
        about_x, about_y, about_z = map(turned_by, np.diag([roll, pitch, yaw]))
        return cls(row, holds[word], place, product(product(about_x, about_y), about_z))


class _Reader:
    """A scene from a file, and notes on what it leaves out."""

    def __init__(self, file: MoorDynFile):
        self.file = file
        self.notes: list[str] = []
        self.options = self._options()
        self.bodies = file.by_id("bodies", Body.of)
        self.points = file.by_id("points", lambda row: Point.of(row, self.bodies))
        self.types = file.by_id("line types", lambda row: LineType.of(row, Path(file.name).parent))
        self.scene = Scene(gravity=(0, 0, -self.options["g"]))
        self.ends: dict[str, list[tuple[str, float]]] = {name: [] for name in self.points}
        self.loaded = self._mean_tensions()

    def read(self) -> Scene:
        """Return the scene, whose messages are the notes."""
        density = self.options["rhow"]
        if density > 0:
            self.scene.fluid("sea", density=density, surface=0.0)
        depth = max(self.options["wtrdpth"], *(-float(point.place[2]) for point in self.points.values()))
        self.scene.surface("bed", Plane(point=(0, 0, -depth), normal=(0, 0, 1)))
        for name, body in self.bodies.items():
            if body.how in TURNING:
                self._body(f"body_{name}", body)
        for row in self.file.rows("lines"):
            self._line(row)
        for name, point in self.points.items():
            self._point(f"point_{name}", point, self.ends[name])
        self._leave_out()
        self.scene.run_settings = {"duration": DURATION, "initial": "equilibrium"}
        self.scene.messages += self.notes
        return self.scene

    def _options(self) -> dict[str, float]:
        found = dict(DEFAULTS)
        for row in self.file.rows("options"):
            given = row.word(1, "the name of an option").lower()
            name = SYNONYMS.get(given, given)
            if name in DEFAULTS:
                found[name] = row.number(0, row.words[1])
            elif name in LEFT_OUT and row.words[0] not in ("0", "0.0"):
                self.notes.append(f"{row.where}: {LEFT_OUT[name]}")
            elif name not in LEFT_OUT and name not in NUMERICAL:
                self.notes.append(f"{row.where}: the option {shown(row.words[1])} is not known and is left out")
        return found

    def _mean_tensions(self) -> dict[str, Loaded]:
        """Return the mean tensions before the start by lines. Raises SceneError."""
        found: dict[str, Loaded] = {}
        lines = self.file.by_id("lines", lambda row: row)
        for row in self.file.rows("mean tensions"):
            loaded = Loaded(row.number(1, "Tmax0"), row.number(2, "Tmean0"))
            if not loaded.highest >= loaded.mean >= 0:
                raise row.refused(f"Tmax0 must be at least Tmean0, and both not negative, got {show(loaded.highest)} "
                                  f"and {show(loaded.mean)} N")
            for name in row.words[0].split(","):
                named(lines, name, row, "line")
                found[name] = loaded
        return found

    def _memory(self, row: Row, name: str, kind: LineType, loaded: Loaded) -> None:
        """Add the working curve and the viscosity of a line."""
        axial = kind.axial
        if axial.curves is not None and axial.table is not None:
            self.scene.working_curve(name, **axial.curves.curve(row, axial.table, loaded), name=f"{name}_curve")
            self.notes.append(f"{row.where}: the stiffness of fast changes is that of the mean tension "
                              f"{show(loaded.mean, 'N')}, and stays")
            if axial.curves.depends_on_tension:
                self.notes.append(f"{row.where}: the working curve is that from the highest tension "
                                  f"{show(loaded.highest, 'N')}; from other ones it is scaled in both directions")
        if axial.spring:
            self.scene.relaxation(name, stiffness=axial.spring, time=axial.time, name=f"{name}_viscosity")

    def _line(self, row: Row) -> None:
        """Add a line as a cable with its drag and its contact with the bed."""
        name, kind = f"line_{row.words[0]}", named(self.types, row.word(1, "LineType"), row, "line type")
        loaded = self.loaded.get(row.words[0], Loaded())
        kind = replace(kind, axial=kind.axial.under(row, loaded))
        if name in self.scene.cables:
            raise row.refused(f"there is already a line {shown(row.words[0])} of lines", "give each its own ID")
        ends = [self._end(row, k) for k in (2, 3)]
        start, end = (self.points[each].place for each in ends)
        length, segments = row.number(4, "UnstrLen"), row.number(5, "NumSegs")
        if not length > 0 or not 1 <= segments <= 1e6 or segments % 1:
            raise row.refused(f"UnstrLen must be positive and NumSegs a whole number, got {show(length)} m and "
                              f"{show(segments)}")
        with _at(row):
            cable = self.scene.cable(
                name, start=tuple(start.tolist()), end=tuple(end.tolist()), rest="straight", rest_length=length,
                elements=int(segments), element="cable12", strain="engineering", membrane=kind.membrane,
                section=kind.section(), material=kind.material(length / segments))
            self._memory(row, name, kind, loaded)
            self._drag(name, kind)
            self._bed(name, kind)
        for s, each in zip((0.0, cable.length), ends, strict=True):
            self.ends[each].append((name, s))

    def _end(self, row: Row, k: int) -> str:
        """Return the point of an end of a line. Raises SceneError."""
        word = row.word(k, "AttachA" if k == 2 else "AttachB")
        name = word.upper().removeprefix("POINT").removeprefix("CON").removeprefix("P").removeprefix("C")
        if name.startswith("R"):
            raise row.refused(f"ends at rod {shown(word)}, and rods are not read", "give the end a point, and add a "
                              "rigid body to the scene written")
        named(self.points, name, row, "point")
        return name

    def _drag(self, name: str, kind: LineType) -> None:
        if self.options["rhow"] > 0 and kind.diameter > 0:
            self.scene.drag(name, normal=kind.drag[0], tangential=kind.drag[1], diameter=kind.diameter,
                            added_mass=kind.added[0], added_mass_tangential=kind.added[1], added_mass_form="morison",
                            name=f"{name}_water")

    def _bed(self, name: str, kind: LineType) -> None:
        """Add contact with the bed, whose damping is MoorDyn's at the depth of the line at rest on it."""
        weight = (kind.mass - self.options["rhow"] * math.pi / 4 * kind.diameter**2) * self.options["g"]
        stiffness = self.options["kbot"] * kind.diameter
        if not stiffness > 0 or not weight > 0:
            return
        self.scene.contact(name, "bed", stiffness=stiffness, radius=BED_RADIUS, name=f"{name}_on_bed",
                           damping=self.options["cbot"] * kind.diameter / weight,
                           friction=self.options["frictioncoefficient"] or None)

    def _point(self, name: str, point: Point, ends: list[tuple[str, float]]) -> None:
        """Hold the ends of lines at a point, or tie them to each other with its mass."""
        if not ends:
            self.notes.append(f"{point.row.where}: the point has no line and is left out")
            return
        with _at(point.row):
            if point.body is not None:
                of = self.bodies[point.body]
                place = tuple(((point.place - of.place) @ of.axes).tolist())
                for k, end in enumerate(ends):
                    self.scene.joint("spherical", end, (f"body_{point.body}", place), name=f"{name}_{k + 1}")
            elif point.how != "free":
                for cable, s in ends:
                    self.scene.pin(cable, s=s)
                if point.how == "moved":
                    self.notes.append(f"{point.row.where}: the point is held where it is drawn; in the place of its "
                                      "pin give a motion, as the program does that moves it")
            else:
                self._join(name, point, ends)
            if (point.how != "free" or point.body is not None) and (point.mass or point.volume or point.drag):
                self.notes.append(f"{point.row.where}: M, V and CdA of a point that is not free are left out")

    def _join(self, name: str, point: Point, ends: list[tuple[str, float]]) -> None:
        (cable, s), *others = ends
        for k, (other, at) in enumerate(others, start=1):
            self.scene.tie(cable, s=s, to=other, at=at, rotation="free", name=f"{name}_tie_{k}")
        if any(point.force):
            self.scene.force(cable, s=s, value=point.force, name=f"{name}_force")
        if not point.mass and not point.volume and not point.drag:
            return
        self.scene.point_mass(cable, s=s, mass=point.mass, name=name)
        if self.options["rhow"] > 0 and (point.volume or point.drag):
            self.scene.drag(name, area=point.drag, volume=point.volume, name=f"{name}_water",
                            added_mass=point.added if point.volume else None)

    def _body(self, name: str, body: Body) -> None:
        """Add a body that turns, with buoyancy and drag at its origin."""
        row = body.row
        mass, centre = row.number(8, "Mass"), row.numbers(9, "CG", 3) if "|" in row.word(9, "CG") else (
            0.0, 0.0, row.number(9, "CG"))
        inertia, volume = row.numbers(10, "I", 3), row.number(11, "Volume", 0.0)
        drag, added = (_along_and_about(row, k, what) if k < len(row.words) else (0.0,) * 6
                       for k, what in ((12, "CdA"), (13, "Ca")))
        if len(set(drag[:3])) > 1 or len(set(added[:3])) > 1 or any(drag[3:]):
            self.notes.append(f"{row.where}: drag and added mass of the body take the mean of CdA and of Ca along its "
                              "axes, and none of rotations")
        CdA, Ca = float(np.mean(drag[:3])), float(np.mean(added[:3]))
        with _at(row):
            self.scene.rigid_body(name, mass=mass, inertia=inertia, centre=centre, position=tuple(body.place.tolist()),
                                  orientation=tuple(body.orientation.tolist()))
            if body.how == "pinned":
                self.scene.joint("spherical", name, tuple(body.place.tolist()), name=f"{name}_held")
                self.notes.append(f"{row.where}: the body is held where it is drawn; give its joint a motion, as the "
                                  "program does that moves it")
            if self.options["rhow"] > 0 and (volume or CdA):
                self.scene.drag(name, area=CdA, volume=volume, name=f"{name}_water",
                                added_mass=Ca if volume else None)

    def _leave_out(self) -> None:
        """Note the tables that are not read."""
        for table in ("rod types", "rods", "failures", "control"):
            if rows := self.file.rows(table):
                self.notes.append(f"{rows[0].where}: {table} are left out")
        for kind in self.types.values():
            self.notes += kind.axial.notes
        if any(kind.diameter == 0 for kind in self.types.values()):
            self.notes.append("lines of diameter 0 have no water and no bed")


def _along_and_about(row: Row, k: int, what: str) -> tuple[float, ...]:
    """Return coefficients along and about the axes (6) from 1, 2 (along, about), 3 (along) or 6 numbers, as MoorDyn
    reads them. Raises SceneError.
    """
    size = row.word(k, what).count("|") + 1
    found = row.numbers(k, what, size if size in (2, 6) else 3)
    return found if size == 6 else tuple(np.repeat(found, 3).tolist()) if size == 2 else found * 2


class _at:  # noqa: N801  it reads as a word
    """The context that puts the place of a line of the file before errors of parts."""

    def __init__(self, row: Row):
        self.row = row

    def __enter__(self) -> None:
        """Do nothing before the part is made."""

    def __exit__(self, kind: Any, error: BaseException | None, trace: Any) -> None:
        """Raise a SceneError with the place in front."""
        if isinstance(error, SceneError):
            raise error.inside(self.row.where) from None


def read_moordyn(path: str | os.PathLike[str]) -> Scene:
    """Return the scene of an input file of MoorDyn-2.

    Lines become cables of the names line_1, line_2, ... with as many elements as they have segments, in water up to
    z = 0 above an even bed; fixed and coupled points hold them by pins, free points are ties of line ends with a
    `PointMass`; free bodies are rigid bodies, others hold the points on them. Lines pull alone, by EA, by the table of
    a file (`TensionTable`, a cubic between its points), by static|dynamic stiffness, which is EA with a `Relaxation`,
    or as ropes of fibres (SYROPE) by a table with a `WorkingCurve` and a `Relaxation`. The run starts from rest.
    ``messages`` of the scene say what it leaves out. Raises SceneError.
    """
    return _Reader(read_file(path)).read()
