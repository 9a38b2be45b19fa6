"""What a C compiler needs to use the kernels: `python -m funicular.generated --include` and `--sources`.

    cc program.c $(python -m funicular.generated --include --sources) -lm

Written by `funicular derive`.
"""

import argparse
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCES = (
    "beam24.c",
    "cable12.c",
    "cable18.c",
    "beam12p.c",
    "cable8p.c",
    "beam24_continuum.c",
    "beam24_continuum_curved.c",
    "beam24_structural.c",
    "cable12_green_exact.c",
    "cable12_green_linear.c",
    "cable12_engineering_exact.c",
    "cable12_engineering_linear.c",
    "cable12_green_exact_assumed.c",
    "cable12_green_linear_assumed.c",
    "cable12_engineering_exact_assumed.c",
    "cable12_engineering_linear_assumed.c",
    "cable12_green_exact_curved.c",
    "cable12_engineering_exact_curved.c",
    "cable12_engineering_exact_tension_only.c",
    "cable12_engineering_exact_tabulated.c",
    "cable18_green_exact.c",
    "cable18_engineering_exact.c",
    "cable18_green_exact_assumed.c",
    "cable18_engineering_exact_assumed.c",
    "beam12p_continuum.c",
    "beam12p_continuum_curved.c",
    "beam12p_structural.c",
    "cable8p_green_exact.c",
    "cable8p_green_linear.c",
    "cable8p_engineering_exact.c",
    "cable8p_engineering_linear.c",
    "cable8p_green_exact_assumed.c",
    "cable8p_green_linear_assumed.c",
    "cable8p_engineering_exact_assumed.c",
    "cable8p_engineering_linear_assumed.c",
    "cable8p_engineering_exact_tension_only.c",
    "cable8p_engineering_exact_tabulated.c",
    "rigid.c",
    "planar_rigid.c",
    "modal.c",
    "planar_modal.c",
    "slide_beam24_rigid.c",
    "slide_beam24_point.c",
    "slide_cable12_rigid.c",
    "slide_cable12_point.c",
    "slide_cable18_rigid.c",
    "slide_cable18_point.c",
    "slide_beam12p_planar_rigid.c",
    "slide_beam12p_planar_point.c",
    "slide_cable8p_planar_rigid.c",
    "slide_cable8p_planar_point.c",
    "slide_span_cable8p_planar_rigid.c",
    "slide_span_cable8p_planar_point.c",
    "slide_span_cable12_rigid.c",
    "slide_span_cable12_point.c",
    "branch.c",
    "planar_branch.c",
    "crossing.c",
    "planar_crossing.c",
    "drag.c",
    "planar_drag.c",
    "frame.c",
    "planar_frame.c",
    "joint_spherical.c",
    "joint_revolute.c",
    "joint_revolute_angle.c",
    "joint_universal.c",
    "joint_cylindrical.c",
    "joint_cylindrical_angle.c",
    "joint_cylindrical_distance.c",
    "joint_prismatic.c",
    "joint_prismatic_distance.c",
    "joint_weld.c",
    "joint_distance.c",
    "joint_aligned.c",
    "joint_locked.c",
    "joint_turning.c",
    "joint_sliding.c",
    "joint_turning_sliding.c",
    "joint_planar_spherical.c",
    "joint_planar_revolute_angle.c",
    "joint_planar_prismatic.c",
    "joint_planar_prismatic_distance.c",
    "joint_planar_weld.c",
    "joint_planar_distance.c",
    "joint_planar_locked.c",
    "joint_planar_turning.c",
    "joint_planar_sliding.c",
    "spring.c",
    "planar_spring.c",
    "spring_segment.c",
    "planar_spring_segment.c",
    "zero_length_spring.c",
    "planar_zero_length_spring.c",
    "resistance.c",
    "planar_resistance.c",
    "planar_rope_point.c",
    "rope_point.c",
    "planar_sheave.c",
    "span_cable8p.c",
    "span_cable12.c",
    "surface.c",
    "planar_surface.c",
    "tangent_point.c",
    "taut_part.c",
    "planar_taut_rope.c",
    "working_curve.c",
    "planar_working_curve.c",
    "registry.c",
)
"""C files of the kernels; each can be compiled without the others but for registry.c, which has tables of all."""


def main() -> None:
    """Print what is asked for, all without options."""
    parser = argparse.ArgumentParser(prog="python -m funicular.generated", description=__doc__.partition(":")[0] + ".")
    parser.add_argument("--include", action="store_true", help="print the option for the folder of kernels.h")
    parser.add_argument("--sources", action="store_true", help="print the C files")
    given = parser.parse_args()
    if given.include or not given.sources:
        print(f"-I{HERE}")
    if given.sources or not given.include:
        print("\n".join(str(HERE / name) for name in SOURCES))


if __name__ == "__main__":
    main()
