"""Arithmetic operations per call of every kernel, by family: a ceiling moves down when a kernel gets cheaper, up only
on purpose.
"""

CEILINGS = {
    "beam24": {
        "mass": 58, "gravity": 26, "inertia_force": 120, "position": 70,
        "on_axis": 34, "follower_force": 615, "moment": 1158
    },
    "cable12": {
        "mass": 40, "gravity": 26, "inertia_force": 84, "position": 40,
        "on_axis": 34, "follower_force": 327, "moment": 303
    },
    "cable18": {
        "mass": 105, "gravity": 42, "inertia_force": 198, "position": 85,
        "on_axis": 94, "follower_force": 633, "moment": 546
    },
    "beam12p": {
        "mass": 49, "gravity": 22, "inertia_force": 68, "position": 44,
        "on_axis": 34, "follower_force": 167, "moment": 61
    },
    "cable8p": {
        "mass": 40, "gravity": 22, "inertia_force": 56, "position": 33,
        "on_axis": 34, "follower_force": 167, "moment": 141
    },
    "beam24_continuum": {
        "stiffness": 217, "energy": 485, "elastic_force": 756, "elastic_tangent": 5124, "damping_force": 991,
        "damping_tangent": 8797, "dissipation": 692, "section_forces": 487
    },
    "beam24_continuum_curved": {
        "stiffness_at": 1949, "energy": 1857, "elastic_force": 2128, "elastic_tangent": 12610, "damping_force": 991,
        "damping_tangent": 8797, "dissipation": 692, "section_forces": 4561
    },
    "cable12_green_exact_curved": {
        "stiffness": 255, "energy": 299, "elastic_force": 710, "elastic_tangent": 3087, "damping_force": 558,
        "damping_tangent": 3498, "dissipation": 298, "section_forces": 604
    },
    "cable12_engineering_exact_curved": {
        "stiffness": 255, "energy": 314, "elastic_force": 730, "elastic_tangent": 3157, "damping_force": 588,
        "damping_tangent": 3753, "dissipation": 319, "section_forces": 611
    },
    "beam12p_continuum_curved": {
        "stiffness_at": 518, "energy": 571, "elastic_force": 655, "elastic_tangent": 2589, "damping_force": 395,
        "damping_tangent": 2125, "dissipation": 296, "section_forces": 608
    },
    "cable12_green_exact": {
        "stiffness": 0, "energy": 229, "elastic_force": 485, "elastic_tangent": 2012, "damping_force": 558,
        "damping_tangent": 3498, "dissipation": 298, "section_forces": 262
    },
    "cable12_green_linear": {
        "stiffness": 0, "energy": 143, "elastic_force": 252, "elastic_tangent": 766, "damping_force": 558,
        "damping_tangent": 3498, "dissipation": 298, "section_forces": 154
    },
    "cable12_engineering_exact": {
        "stiffness": 0, "energy": 239, "elastic_force": 490, "elastic_tangent": 2027, "damping_force": 588,
        "damping_tangent": 3753, "dissipation": 319, "section_forces": 257
    },
    "cable12_engineering_linear": {
        "stiffness": 0, "energy": 158, "elastic_force": 277, "elastic_tangent": 841, "damping_force": 588,
        "damping_tangent": 3753, "dissipation": 319, "section_forces": 158
    },
    "cable18_green_exact": {
        "stiffness": 0, "energy": 591, "elastic_force": 1251, "elastic_tangent": 5776, "damping_force": 1771,
        "damping_tangent": 12937, "dissipation": 1018, "section_forces": 520
    },
    "cable18_engineering_exact": {
        "stiffness": 0, "energy": 601, "elastic_force": 1256, "elastic_tangent": 5791, "damping_force": 1821,
        "damping_tangent": 13362, "dissipation": 1053, "section_forces": 515
    },
    "beam12p_continuum": {
        "stiffness": 94, "energy": 218, "elastic_force": 302, "elastic_tangent": 1294, "damping_force": 395,
        "damping_tangent": 2125, "dissipation": 296, "section_forces": 142
    },
    "cable8p_green_exact": {
        "stiffness": 0, "energy": 208, "elastic_force": 438, "elastic_tangent": 1276, "damping_force": 335,
        "damping_tangent": 1371, "dissipation": 202, "section_forces": 186
    },
    "cable8p_green_linear": {
        "stiffness": 0, "energy": 122, "elastic_force": 205, "elastic_tangent": 433, "damping_force": 335,
        "damping_tangent": 1371, "dissipation": 202, "section_forces": 100
    },
    "cable8p_engineering_exact": {
        "stiffness": 0, "energy": 218, "elastic_force": 443, "elastic_tangent": 1291, "damping_force": 356,
        "damping_tangent": 1500, "dissipation": 217, "section_forces": 181
    },
    "cable8p_engineering_linear": {
        "stiffness": 0, "energy": 137, "elastic_force": 230, "elastic_tangent": 508, "damping_force": 356,
        "damping_tangent": 1500, "dissipation": 217, "section_forces": 104
    },
    "beam24_structural": {
        "stiffness": 313, "energy": 510, "elastic_force": 997, "elastic_tangent": 6802, "damping_force": 1286,
        "damping_tangent": 13055, "dissipation": 849, "section_forces": 724
    },
    "beam12p_structural": {
        "stiffness": 105, "energy": 207, "elastic_force": 302, "elastic_tangent": 1081, "damping_force": 394,
        "damping_tangent": 2006, "dissipation": 296, "section_forces": 263
    },
    "rigid": {"point": 207, "point_force": 183, "inertia_force": 45, "inertia_tangent": 48, "kinetic_energy": 31},
    "planar_rigid": {"point": 40, "point_force": 23, "inertia_force": 3, "inertia_tangent": 0, "kinetic_energy": 9},
    "slide_beam24_rigid": {"constraint": 596, "terms": 1646, "residual": 208, "tangent": 285},
    "slide_cable12_rigid": {"constraint": 469, "terms": 1429, "residual": 208, "tangent": 285},
    "slide_cable18_rigid": {"constraint": 695, "terms": 2198, "residual": 331, "tangent": 511},
    "slide_beam12p_planar_rigid": {"constraint": 154, "terms": 568, "residual": 96, "tangent": 112},
    "slide_cable8p_planar_rigid": {"constraint": 154, "terms": 568, "residual": 96, "tangent": 112},
}
