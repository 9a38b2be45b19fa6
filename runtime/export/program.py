"""The folder of a scene's program in C: the engine, its kernels, the packed scene, an example, a Makefile."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..base.written_files import write_text
from ..errors import SceneError, shown_path
from .scene_image import SceneImage
from .sources import Kernels, engine_files, kernels_of

MARK = "funicular.h"
"""A file that only folders of exports have."""
WORDS_A_LINE = 5
MAX_COLUMNS = 12
"""Values that the example prints by itself."""
BY_THEMSELVES = r"\.(position\.[xyz]|s)$"


class Exported(NamedTuple):
    """An export: its folder; the integrator and the reason for it; the names of the values of a row; the results that
    have no value in C; messages.
    """

    folder: Path
    integrator: str
    reason: str
    values: list[str]
    missing: list[str]
    messages: list[str]


def write_program(folder: str | os.PathLike[str], image: SceneImage) -> Exported:
    """Write the program of a scene to a folder, which is new, empty, or of an earlier export. Raises SceneError."""
    top = Path(folder)
    if top.exists() and not (top.is_dir() and (not any(top.iterdir()) or (top / MARK).is_file())):
        raise SceneError("export", f"{shown_path(top)} exists and is no folder of an export", "take a new folder")
    name = "scene_" + re.sub(r"\W", "_", top.resolve().name, flags=re.ASCII)
    for file, text in _files(name, image).items():
        (top / file).parent.mkdir(parents=True, exist_ok=True)
        write_text(top / file, text)
    return Exported(top, image.integrator, image.reason, sorted(each.name for each in image.values), image.missing,
                    _messages(image))


def _messages(image: SceneImage) -> list[str]:
    """Return what the user of an export should know."""
    found = []
    if image.missing:
        found.append("results without a value in C, which Python computes from several numbers: "
                     f"{', '.join(image.missing)}")
    if image.has_lapack:
        found.append("the program solves large matrices by its own functions, not by SciPy's LAPACK: its results equal "
                     "those of a run up to rounding")
    return found


def _files(name: str, image: SceneImage) -> dict[str, str]:
    """Return the texts of all files by path."""
    engine, kernels = engine_files(), kernels_of(image.packed.kernels)
    files = {f"engine/{path}": text for path, text in engine.items() if path != "host/funicular.h"}
    files |= {f"kernels/{path}": text for path, text in kernels.files.items()}
    files |= {"engine/host/funicular.h": engine["host/funicular.h"], MARK: engine["host/funicular.h"],
              "scene.h": _header(name), "scene.c": _scene(name, image, kernels), "main.c": _example(name, image)}
    compiled = ["scene.c", *(f"engine/{path}" for path in engine if path.endswith(".c")),
                *(f"kernels/{path}" for path in kernels.compiled)]
    return files | {"Makefile": _makefile(compiled), "CMakeLists.txt": _cmake(compiled)}


def _header(name: str) -> str:
    return f"""/* The scene of this folder, for funicular_open. */
#ifndef FUNICULAR_{name.upper()}_H
#define FUNICULAR_{name.upper()}_H

#include "funicular.h"

#ifdef __cplusplus
extern "C" {{
#endif
extern const funicular_scene {name};
#ifdef __cplusplus
}}
#endif

#endif
"""


def _scene(name: str, image: SceneImage, kernels: Kernels) -> str:
    words = [f"0x{word:x}" for word in np.frombuffer(image.packed.content, dtype=np.uint64).tolist()]
    lines = ",\n    ".join(", ".join(words[k : k + WORDS_A_LINE]) for k in range(0, len(words), WORDS_A_LINE))
    digest = ", ".join(map(str, image.packed.digest))
    return f"""/* The packed scene, and the registry of the kernels that it uses. Written by funicular; export the scene
 * anew to change it: another scene's bytes are refused. */
#include "scene.h"
#include "host/packed.h"
#include "kernels.h"
#include "linear/plain_lapack.h"

{kernels.tables}
static const uint64_t bytes[] = {{
    {lines}}};

static const unsigned char digest[FU_DIGEST_BYTES] = {{
    {digest}}};
static const fu_registry registry = {{digest, kernels, &fu_plain_lapack}};
const funicular_scene {name} = {{bytes, sizeof bytes, &registry}};
"""


def _example(name: str, image: SceneImage) -> str:
    known = sorted(each.name for each in image.values)
    shown = ["time", *[each for each in known if re.search(BY_THEMSELVES, each)][:MAX_COLUMNS]]
    columns = ",\n        ".join(f'"{each}"' for each in shown)
    return f"""/* Runs the scene and prints values of its rows: those named on the command line, or some positions. */
#include "funicular.h"
#include "scene.h"

#include <stdio.h>
#include <stdlib.h>

static const char *const columns[] = {{
        {columns}}};

int main(int count, char **arguments)
{{
    char message[FUNICULAR_MESSAGE];
    funicular *run = funicular_open(&{name}, NULL, message);
    if (!run) {{
        fprintf(stderr, "%s\\n", message);
        return EXIT_FAILURE;
    }}
    const int given = count - 1, n = given ? given : (int)(sizeof columns / sizeof *columns);
    int *references = malloc(sizeof *references * (size_t)n);
    double *values = malloc(sizeof *values * (size_t)n);
    if (!references || !values) return EXIT_FAILURE;
    for (int i = 0; i < n; ++i) {{
        const char *column = given ? arguments[1 + i] : columns[i];
        references[i] = funicular_find(run, column);
        printf("%s%s", i ? "," : "", column);
    }}
    printf("\\n");
    funicular_status status = FUNICULAR_RUNNING;
    while (status == FUNICULAR_RUNNING) {{
        status = funicular_step(run);
        if (funicular_get(run, references, (size_t)n, values)) break;
        for (int i = 0; i < n; ++i) printf("%s%.17g", i ? "," : "", values[i]);
        printf("\\n");
    }}
    fprintf(stderr, "%s\\n", funicular_message(run));
    funicular_close(run);
    free(values);
    free(references);
    return status == FUNICULAR_DONE || status == FUNICULAR_STOPPED ? EXIT_SUCCESS : EXIT_FAILURE;
}}
"""


def _makefile(compiled: list[str]) -> str:
    sources = " \\\n    ".join(compiled)
    return f"""# make: the example `main`, and the library libscene.a of the engine with the scene
CC ?= cc
CFLAGS ?= -O2
WARNINGS ?= -Wall -Wextra
OPTIONS = -std=c11 -ffp-contract=off -fno-math-errno -pthread -I. -Iengine -Ikernels
SOURCES = \\
    {sources}
OBJECTS = $(SOURCES:%.c=build/%.o)

main: main.c funicular.h scene.h libscene.a
\t$(CC) $(OPTIONS) $(WARNINGS) $(CFLAGS) main.c libscene.a -lm -o $@

libscene.a: $(OBJECTS)
\t$(AR) rcs $@ $(OBJECTS)

build/%.o: %.c
\t@mkdir -p $(@D)
\t$(CC) $(OPTIONS) $(WARNINGS) $(CFLAGS) -c $< -o $@

clean:
\trm -rf build libscene.a main

.PHONY: clean
"""


def _cmake(compiled: list[str]) -> str:
    sources = "\n    ".join(compiled)
    return f"""# The example `main`, and the library `scene` of the engine with the scene.
cmake_minimum_required(VERSION 3.16)
project(scene C)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
find_package(Threads REQUIRED)
add_library(scene STATIC
    {sources})
set_target_properties(scene PROPERTIES C_STANDARD 11 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
target_include_directories(scene PUBLIC . PRIVATE engine kernels)
target_compile_options(scene PRIVATE -ffp-contract=off -fno-math-errno)
target_link_libraries(scene PUBLIC Threads::Threads m)
add_executable(main main.c)
set_target_properties(main PROPERTIES C_STANDARD 11 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
target_link_libraries(main PRIVATE scene)
"""
