#!/usr/bin/env bash
# The engine's tests with both extension modules built under AddressSanitizer and UndefinedBehaviorSanitizer: reads and
# writes outside of arrays, of memory that is freed, overflows, shifts, misaligned and null pointers end a test at once.
#
#   bash tests/sanitize/run.sh [ARGUMENTS OF PYTEST]
#
# Without arguments a selection that reaches every integrator, joint, element and event, the statics, and forged
# checkpoints. Needs gcc with its sanitizers, and the environment of README.md in .venv (or PYTHON); leaves nothing
# behind.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
python=${PYTHON:-$top/.venv/bin/python}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

compiler=${CC:-gcc}
runtime=$($compiler -print-file-name=libasan.so)
if [ ! -e "$runtime" ]; then
  echo "tests/sanitize: $compiler has no libasan.so; give a gcc that has one as CC" >&2
  exit 1
fi

mkdir "$work/copy"
cd "$top"
tar --exclude=__pycache__ --exclude='*.so' --exclude=generated/kernels.c --exclude=runtime/engine.c \
  -cf - LICENSE README.md pyproject.toml derive generated runtime tests | tar -xf - -C "$work/copy"
cd "$work/copy"
sed -i -e 's/"-g0", "-O2"/"-g1", "-O1"/' -e 's/"-g0"/"-g1", "-O1"/' pyproject.toml

flags="-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer"
options=(-q --no-deps --target "$work/site")
if "$python" -c "import Cython, setuptools, numpy, scipy" 2>"$work/none"; then
  options+=(--no-build-isolation)  # what builds it is there already
fi
CC=$compiler CFLAGS=$flags LDFLAGS=$flags "$python" -m pip install "${options[@]}" .
printf 'built in %d s\n' "$SECONDS"

# leaks are Python's; its own pools would hide from the sanitizer what lies beside an array
export LD_PRELOAD=$runtime PYTHONMALLOC=malloc PYTHONPATH=$work/site MPLBACKEND=Agg
export ASAN_OPTIONS=detect_leaks=0:abort_on_error=1 UBSAN_OPTIONS=print_stacktrace=1
"$python" -c "import funicular, sys; sys.exit(funicular.__path__[0] != '$work/site/funicular')"
if [ $# -eq 0 ]; then
  set -- tests/motion/test_integrators.py tests/motion/test_joints.py tests/contact/test_friction.py tests/motion/test_cable_ends.py \
    tests/motion/test_{events,modal_joints,sticking_joints,energy_integrator}.py \
    tests/motion/test_{drums,ropes,ropes_in_space}.py::test_energy_and_the_agreement_of_integrators \
    tests/motion/test_sticking_ropes.py::test_energy_and_the_agreement_of_integrators_where_ropes_stick \
    tests/results/test_streaming.py::test_every_integrator_goes_on_exactly \
    tests/results/test_damaged_files.py::test_forged_states_are_refused_or_run \
    tests/export/test_exported_c.py::test_forged_bytes_are_refused
fi
"$python" -m pytest -p no:cacheprovider -x "$@"
printf 'passed after %d s\n' "$SECONDS"
