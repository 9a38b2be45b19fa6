"""The number of threads is bounded by the machine; a fork refuses them; BLAS uses one during a run."""

import os
import subprocess
import sys
import threading

import funicular as fu
import linear_cost
import pytest
from funicular.base.lapack import cython_lapack
from funicular.solve.linear import threads
from shared_scenes import cable_scene
from threadpoolctl import ThreadpoolController, threadpool_limits


def scene(body: float = 0.5) -> fu.Scene:
    made = cable_scene("rope", pins=(0, 1), elements=4, element="cable12", section=fu.Circle(radius=0.01),
                       material=fu.Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000))
    made.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(body, 0, 0))
    made.slide("A", along="rope", s=body)
    return made


@pytest.mark.parametrize("asked", [10**4, 10**5, 10**6])
def test_no_more_threads_than_processors(asked, monkeypatch):
    """Requests of 10^4 and 10^5 threads are bounded."""
    monkeypatch.setattr("funicular.solve.linear.threads.available", lambda: 2)
    run = scene().run(1e-3, step=5e-4, output_step=5e-4, threads=asked)
    assert run.status == "completed"
    assert run.report["messages"][0] == f"threads = {asked} came to 2: there are 2 processors for this process"


def test_there_are_processors():
    assert threads.available() >= 1


FORKED = """
import os, sys
sys.path += ["tests", "tests/benchmarks", "tests/engine"]
import funicular.solve.linear.threads
from test_threads import scene
funicular.solve.linear.threads.available = lambda: 2
before = scene().run(1e-3, step=5e-4, output_step=5e-4, threads={parent})
child = os.fork()
if child:
    sys.exit(os.waitpid(child, 0)[1] != 0)
after = scene().run(1e-3, step=5e-4, output_step=5e-4, threads=2)
assert after["rope.nodal_vectors"].tobytes() == before["rope.nodal_vectors"].tobytes()
print(*after.report["messages"], flush=True)
"""


@pytest.mark.parametrize("parent", [1, 2])
@pytest.mark.slow_cases("1")
def test_threads_after_a_fork(parent, request):
    """Threads belong to their run: a forked process starts its own and does not wait for those of its parent."""
    done = subprocess.run([sys.executable, "-c", FORKED.format(parent=parent)], capture_output=True, text=True,
                          timeout=60, check=True, cwd=request.config.rootpath)
    assert not done.stdout.strip()


WITHIN = """
import os, sys
sys.path += ["tests", "tests/benchmarks", "tests/engine"]
import funicular.solve.linear.threads
from linear_cost import scene
funicular.solve.linear.threads.available = lambda: 2
children = []

def fork(time):
    if not children:
        children.append(os.fork())

run = scene("pendulum", 200).run(2e-3, step=1e-5, output_step=5e-4, threads=2, progress=fork)
if children[0] == 0:
    os._exit(run.status != "completed")
sys.exit(os.waitpid(children[0], 0)[1] != 0)
"""


@pytest.mark.slow
def test_a_fork_within_a_run(request):
    """The run continues in both processes, in the forked one without threads."""
    subprocess.run([sys.executable, "-c", WITHIN], timeout=60, check=True, cwd=request.config.rootpath)


@pytest.mark.parametrize(("name", "elements"), [("pendulum", 180), ("three riders", 180), ("three cables", 600),
                                                ("ring", 189), ("ladder", 90)])
@pytest.mark.parametrize("integrator", ["genalpha", "radau"])
def test_long_scenes_have_the_same_bits_with_any_number_of_threads(name, elements, integrator, monkeypatch):
    """Elements that share unknowns are included: at joints, at rungs, at the ends of a ring."""
    monkeypatch.setattr("funicular.solve.linear.threads.available", lambda: 3)
    made = linear_cost.scene(name, elements)
    runs = [made.run(4e-4, integrator=integrator, step=1e-4, output_step=2e-4, threads=number) for number in (1, 2, 3)]
    for run in runs[1:]:
        assert run.report["messages"] == runs[0].report["messages"]
        for array in ("energy.kinetic", "energy.elastic", *(key for key in run if key.endswith("nodal_vectors"))):
            assert run[array].tobytes() == runs[0][array].tobytes()


def blas_threads() -> set[int]:
    return {pool["num_threads"] for pool in ThreadpoolController().info() if pool["user_api"] == "blas"}


@pytest.fixture
def two_blas_threads():
    """Set the environment to two threads of BLAS."""
    cython_lapack()  # with SciPy's BLAS
    with threadpool_limits(limits=2, user_api="blas"):
        yield


def test_one_blas_thread_during_a_run(two_blas_threads):
    seen = set()
    scene().run(1e-2, tol=1e-3, progress=lambda time: seen.update(blas_threads()))
    assert seen == {1}
    assert blas_threads() == {2}


def test_scipy_is_held_at_one_thread_from_the_run_that_loads_it():
    code = ("import sys, warnings, funicular as fu; from threadpoolctl import threadpool_info; seen = set()\n"
            "warnings.simplefilter('ignore'); scene = fu.load_scene('aerial_tramway')\n"
            "assert 'scipy' not in sys.modules\n"
            "def look(time): seen.update(each['num_threads'] for each in threadpool_info())\n"
            "scene.run(0.01, output_step=0.005, integrator='genalpha', progress=look)\n"
            "print('scipy' in sys.modules, seen, {each['num_threads'] for each in threadpool_info()})")
    found = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True,
                           env=os.environ | {"OPENBLAS_NUM_THREADS": "2"}).stdout
    assert found == "True {1} {2}\n"


def test_blas_threads_come_back_after_an_error(two_blas_threads):
    def stop(time):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        scene().run(1e-2, progress=stop)
    assert blas_threads() == {2}


@pytest.mark.parametrize("compute", [lambda: scene().equilibrium(), lambda: scene().modes(2, as_drawn=True)],
                         ids=["rest", "modes"])
def test_one_blas_thread_at_rest_and_for_modes(compute, two_blas_threads, monkeypatch):
    from funicular.model.redundant_constraints import drop_redundant_rows

    seen = set()
    monkeypatch.setattr("funicular.solve.statics.static_problem.drop_redundant_rows",  # what both call at first
                        lambda *a: (seen.update(blas_threads()), drop_redundant_rows(*a))[1])
    compute()
    assert seen == {1}
    assert blas_threads() == {2}


def test_blas_threads_come_back_after_the_last_of_several_runs(two_blas_threads):
    first_in, second_in, first_out = threading.Event(), threading.Event(), threading.Event()
    seen = {}

    def first():
        with threads.one_blas_thread:
            first_in.set()
            second_in.wait(30)
        seen["after the first"] = blas_threads()
        first_out.set()

    def second():
        first_in.wait(30)
        with threads.one_blas_thread:
            second_in.set()
            first_out.wait(30)

    both = [threading.Thread(target=work) for work in (first, second)]
    for each in both:
        each.start()
    for each in both:
        each.join()
    assert seen == {"after the first": {1}}
    assert blas_threads() == {2}
