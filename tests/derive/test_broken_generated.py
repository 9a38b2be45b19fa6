"""`funicular derive` starts where generated/ is missing or broken, and mends it."""

import shutil
import subprocess
import sys

import pytest
from import_contracts import TOP
from installed import runnable_tree

DERIVE = "import sys; from funicular.derive.pipeline import main; sys.exit(main(['joint_spherical']))"


@pytest.fixture
def installed(tmp_path):
    """The package's Python files and templates as they stand once it is installed, with generated/ beside derive/."""
    return runnable_tree(tmp_path) / "generated"


def missing(generated):
    shutil.rmtree(generated)


def syntax_error(generated):
    (generated / "__init__.py").write_text("def described(")


def no_manifest_of_ours(generated):
    (generated / "manifest.json").write_text('["tools"]')


def half_a_manifest(generated):
    (generated / "manifest.json").write_text((TOP / "generated" / "manifest.json").read_text(encoding="utf-8")[:1000])


@pytest.mark.parametrize("broken", [missing, syntax_error, no_manifest_of_ours, half_a_manifest])
@pytest.mark.slow_cases("missing", "no_manifest_of_ours")
def test_derive_mends_what_is_generated(installed, broken):
    broken(installed)
    made = subprocess.run([sys.executable, "-c", DERIVE], cwd=installed.parents[1], capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    for name in ("__init__.py", "joint_spherical.c"):
        assert (installed / name).read_bytes() == (TOP / "generated" / name).read_bytes()


def test_a_clone_without_a_compiled_engine_derives(tmp_path):
    """A generated/ that does not compile leaves no engine behind, which `import funicular` needs."""
    ignored = shutil.ignore_patterns("*.so", "__pycache__", "*.c", "page_source", "scenes")
    for folder in ("derive", "runtime"):
        shutil.copytree(TOP / folder, tmp_path / folder, ignore=ignored)
    (tmp_path / "generated").mkdir()
    for name, text in (("manifest.json", None), ("joint_spherical.c", "void joint_spherical_residual(")):
        content = text or (TOP / "generated" / name).read_text(encoding="utf-8")
        (tmp_path / "generated" / name).write_text(content, encoding="utf-8")
    made = subprocess.run([sys.executable, "derive", "joint_spherical"], cwd=tmp_path, capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    for name in ("joint_spherical.c", "kernels.h", "registry.c"):
        assert (tmp_path / "generated" / name).read_bytes() == (TOP / "generated" / name).read_bytes()
