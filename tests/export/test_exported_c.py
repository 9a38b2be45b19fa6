"""Packed scenes and programs in C: the rows of a run bit for bit, saved states, and what is refused."""

import hashlib
import os
import shutil
import subprocess

import funicular as fu
import numpy as np
import pytest
from funicular.engine import PackedRun
from funicular.export.image import COVERED_FROM, DIGEST_AT, HEAD
from funicular.export.sources import ENGINE
from funicular.integrators import INTEGRATORS
from funicular.scene.file import load_scene
from packed_runs import DONE, RUNNING, expected, image, opened, rows

SHORT = {"duration": 0.02, "output_step": 0.002, "initial": "drawn"}


def pendulum() -> fu.Scene:
    """Return a body on a cable, in the plane x, z."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    material = fu.Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1000)
    wire = scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, element="cable8p", up=(0, 0, 1),
                       section=fu.Circle(radius=0.01), material=material)
    scene.pin(wire, s=0.0)
    scene.rigid_body("load", mass=2.0, inertia=(0.1, 0.1, 0.1), position=(1, 0, 0), velocity=(0, 0, 0.5))
    scene.joint("revolute", (wire, 1.0), ("load", (0, 0, 0)), axis=(0, 1, 0), name="hinge")
    return scene


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_packed_scene_gives_the_rows_of_a_run(integrator):
    scene = load_scene("paper51")
    made = image(scene, **SHORT, integrator=integrator)
    one, other = opened(made), opened(made)
    names = [name for name, _ in one.values()]
    assert {"time", "energy.kinetic", "A.position.x", "trolley.s", "trolley.force.y", "wire.nodal_vectors[1].r_x.y"} \
        <= {*names}
    found = rows(one, 4)
    assert np.array_equal(rows(other, 4), found), "two runs in one process"
    found = np.concatenate([found, rows(one)])
    assert np.array_equal(found, expected(scene.run(**SHORT, integrator=integrator), names))
    assert (one.message, one.step()) == ("completed 0.02 s", DONE)


def test_the_same_bytes_twice_and_the_results_of_another_plane():
    scene, settings = pendulum(), {"duration": 0.2, "integrator": "explicit"}
    made = image(scene, **settings)
    assert made == image(scene, **settings)
    run = opened(made)
    assert np.array_equal(rows(run), expected(scene.run(**settings), [name for name, _ in run.values()]))
    assert ("load.position.z", "m") in run.values()


@pytest.mark.parametrize("integrator", ["genalpha", "explicit"])
def test_saved_states_continue_with_the_same_bits(integrator):
    made = image(load_scene("paper51"), **SHORT, integrator=integrator)
    one, other = opened(made), opened(made)
    whole = rows(opened(made))
    rows(one, 4)
    kept = one.save()
    last = one.row()
    assert np.array_equal(rows(one), whole[4:])
    for run in (one, other):
        run.restore(kept)
        assert np.array_equal(run.row(), last) and np.array_equal(rows(run), whole[4:])
    for bad in (kept[:-8], kept[:40] + bytes([kept[40] ^ 1]) + kept[41:], kept[:200] + b"\1" + kept[201:]):
        with pytest.raises(ValueError, match=r"^the saved state is (of another scene|damaged|of no state)"):
            other.restore(bad)


@pytest.mark.parametrize("integrator", ["genalpha", "explicit", "radau"])
def test_inputs_and_any_times_have_the_bits_of_a_simulation(integrator):
    """A force, and the velocity of a drive; over a saved state, which drops what a simulation keeps in between."""
    scene = pendulum()
    scene.force("load", value=(1.0, 0.0, 0.0), name="push")
    scene.joint("prismatic", (0, 0, 0), scene.rigid_body("cart", mass=1.0, inertia=(1, 1, 1), position=(0, 0, 0)),
                axis=(1, 0, 0), velocity=0.0, name="rail")
    inputs, settings = ("push.value.x", "rail.velocity"), {"duration": 0.1, "output_step": 0.01, "tol": 1e-4,
                                                           "integrator": integrator}
    sim, made = scene.simulation(inputs, **settings), image(scene, inputs, **settings)
    one, other = opened(made), opened(made)
    names = ["load.position.x", "cart.position.x", "energy.external", "hinge.force.z"]
    assert one.inputs() == [("push.value.x", "N", 1.0), ("rail.velocity", "", 0.0)]
    one.step()
    for k in range(1, 6):
        given = ("push.value.x", 2.0 * k, 0.0 if k < 4 else 30.0), ("rail.velocity", 0.1 * (k % 3), 0.0)
        for name, value, rate in given:
            sim.set(name, value, rate)
            one.set_input(name, value, rate)
        sim.step(0.003)
        one.reach(sim.time)
        assert one.time == sim.time
        for name in names:
            result, _, axis = name.rpartition(".")
            expected_value = sim[name] if result == "energy" else sim[result]["xyz".index(axis)]
            assert one[name] == expected_value, (k, name)
    kept = one.save()
    other.restore(kept)
    for run in (one, other):
        run.set_input("push.value.x", -3.0)
        run.reach(0.0171)
    assert np.array_equal(one.row(), other.row()) and other.inputs() == one.inputs()
    status = RUNNING
    while status == RUNNING:
        status = one.step()
    assert status == DONE and one.time == 0.1


def test_what_inputs_of_programs_refuse():
    scene = pendulum()
    scene.force("load", value=(1.0, 0.0, 0.0), name="push")
    run = opened(image(scene, ("push.value.x",), duration=0.1, integrator="explicit"))
    for name, value, rate, cause in (("push.value.x", 1.0, 0.0, "after the start"), ("pull", 1.0, 0.0, "is unknown"),
                                     ("push.value.x", np.nan, 0.0, "finite")):
        with pytest.raises(ValueError, match=cause):
            run.set_input(name, value, rate)
    run.step()
    for time in (0.0, -1.0, 0.2, np.nan, 1e-15):
        before = run.time
        assert run.reach(time) == RUNNING and run.time == before
        assert "is not after the last row" in run.message
    assert run.reach(0.1) == DONE


def test_values_are_set_before_the_start_and_times_have_rows():
    scene = pendulum()
    run = opened(image(scene, duration=0.2, integrator="explicit"))
    run["load.velocity.z"] = 0.25
    assert run.advance(0.1) == RUNNING and run.time == pytest.approx(0.1)
    again = scene.replace("load", velocity=(0, 0, 0.25))
    assert run["load.position.z"] == again.run(0.2, integrator="explicit")["load.position"][50, 2]
    with pytest.raises(ValueError, match=r"^velocities are set before the start: open the scene anew$"):
        run["load.velocity.z"] = 0.0
    assert run.advance(0.1003) == RUNNING and run.message.startswith("time 0.1003 s has no row: give a multiple of ")
    assert run.advance(0.2) == DONE
    run = opened(image(scene, duration=0.2, integrator="explicit"))
    for name, value, message in (("load.position.z", 0.0, '"load.position.z" cannot be set: velocities can, before'),
                                 ("load.velocity.z", np.nan, '"load.velocity.z" must be finite')):
        with pytest.raises(ValueError, match=f"^{message}"):
            run[name] = value
    with pytest.raises(ValueError, match=r"^there is no row before the start: call funicular_step first$"):
        run.row()


def signed(content: bytes) -> tuple[bytes, bytes]:
    """Return forged bytes with a right checksum, and that."""
    digest = hashlib.sha256(content[COVERED_FROM:]).digest()
    return content[:DIGEST_AT] + digest + content[COVERED_FROM:], digest


def flipped(content: bytes, bit: int) -> bytes:
    return content[: bit // 8] + bytes([content[bit // 8] ^ 1 << bit % 8]) + content[bit // 8 + 1 :]


def test_forged_bytes_are_refused():
    """Any change is refused, with its checksum as well as with a right one; where a program was made for forged bytes,
    too, their places are checked.
    """
    made = image(pendulum(), duration=0.2, integrator="explicit")
    content, digest, kernels = made.packed
    random = np.random.default_rng(3)
    for bit in random.integers(0, 8 * len(content), 700).tolist():
        for bytes_ in (flipped(content, bit), signed(flipped(content, bit))[0]):
            if bytes_ == content:  # of the checksum itself
                continue
            with pytest.raises(ValueError, match=r"^(the packed scene|these bytes)"):
                PackedRun(bytes_, digest, kernels)
    for bit in random.integers(0, 8 * (len(content) - HEAD.size), 700).tolist():
        try:
            PackedRun(*signed(flipped(content, 8 * HEAD.size + bit)), kernels)
        except ValueError as error:
            assert str(error).startswith(("the packed scene", "the program lacks"))
    for at in range(0, HEAD.size, 4):
        for word in (0, 1, 2**31, 2**32 - 1, 4096):
            bytes_ = content[:at] + word.to_bytes(4, "little") + content[at + 4 :]
            try:
                PackedRun(*signed(bytes_), kernels)
            except (ValueError, MemoryError) as error:
                assert str(error).startswith(("the packed scene", "these bytes", "the machine", "the program lacks"))
    for size in (0, 8, HEAD.size - 1, HEAD.size, len(content) - 8):
        with pytest.raises(ValueError, match=r"^(the packed scene is damaged, its size|these bytes are no packed )"):
            PackedRun(content[:size], digest, kernels)
    with pytest.raises(ValueError, match=r"^the program lacks kernels of the packed scene: export the scene anew"):
        PackedRun(content, digest, kernels[1:])


@pytest.mark.parametrize("name", ["belt_drive", "tower_crane"])
def test_plain_functions_of_lapack_give_the_results_of_a_library(name):
    """The first has a dense border, the second one a band."""
    made = image(load_scene(name), **SHORT, integrator="radau")
    assert made.has_lapack
    found, like = rows(opened(made, plain_lapack=True)), rows(opened(made))
    scale = np.abs(like).max(axis=0)
    assert np.all(np.abs(found - like) <= 1e-7 * np.maximum(scale, 1e-3 * scale.max()))


def test_what_python_computes_is_refused(tmp_path):
    scene = pendulum()
    (tmp_path / "x").write_text("mine")
    with pytest.raises(fu.SceneError, match=r"^export: .* exists and is no folder of an export; take a new folder$"):
        scene.export_c(tmp_path, 0.1)
    scene.event("low", function=lambda time, state: state["load.position"][2] + 0.5)
    with pytest.raises(fu.SceneError, match=r"^event \"low\": cannot be exported to C: its quantity is computed by "
                                            r"Python; leave the event out; quantities"):
        scene.export_c(tmp_path / "new", 0.1)
    assert not (tmp_path / "new").exists()
    scene = load_scene("paper51")
    scene.event("far", quantity="A.position.x", value=0.261, action="stop")
    made = image(scene, **SHORT, integrator="radau")
    run, like = opened(made), scene.run(**SHORT, integrator="radau")
    assert np.array_equal(rows(run), expected(like, [name for name, _ in run.values()]))
    assert like.status == "event" and run.message.startswith("stopped by an event at t = ")


@pytest.mark.slow
def test_programs_print_the_rows_of_runs(tmp_path):
    """The engine is compiled once, without a warning; then the scenes of three programs."""
    make, compiler = shutil.which("make"), shutil.which("cc")
    if not make or not compiler:
        pytest.skip("no make and C compiler")
    first = None
    for name, integrator in (("paper51", "genalpha"), ("cable_car", "radau"), ("zip_line", "explicit")):
        scene, folder = load_scene(name), tmp_path / name
        made = scene.export_c(folder, **SHORT, integrator=integrator)
        assert made.integrator == integrator
        if first is not None:
            shutil.copytree(first / "build" / "engine", folder / "build" / "engine")
            for path in (folder / "build").rglob("*.o"):
                os.utime(path)
        first = first or folder
        subprocess.run([make, "-s", f"-j{os.cpu_count()}", "CFLAGS=-O0 -Wextra -Werror"], cwd=folder, check=True)
        columns = [value for value in made.values if "," not in value]
        printed = subprocess.run(["./main", *columns], cwd=folder, check=True, capture_output=True, text=True).stdout
        found = np.loadtxt(printed.splitlines(), delimiter=",", skiprows=1)
        assert np.array_equal(found, expected(scene.run(**SHORT, integrator=integrator), columns))

@pytest.mark.parametrize(("compiler", "standard"), [("cc", "c11"), ("c++", "c++17")])
def test_the_interface_is_c_and_cpp(compiler, standard, tmp_path):
    if not shutil.which(compiler):
        pytest.skip(f"no {compiler}")
    source = tmp_path / ("x.c" if compiler == "cc" else "x.cc")
    source.write_text('#include "funicular.h"\nstatic const funicular_scene scene = {0, 0, 0};\n'
                      "int main() { return funicular_open(&scene, 0, 0) != 0; }\n".replace("()", "(void)", 1))
    subprocess.run([compiler, f"-std={standard}", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only",
                    f"-I{ENGINE / 'host'}", source], check=True)
