"""Arithmetic operations per call of every kernel, by family: a ceiling moves down when a kernel gets cheaper, up only
on purpose.
"""

POINT_LAW = {"energy": 30, "dissipation": 40, "force": 60, "tangent": 250, "discrete_force": 80}
"""Of a law of the force between two points that has no entry below."""

CEILINGS = {
    "beam24": {
        "mass": 58, "gravity": 26, "inertia_force": 120, "position": 70,
        "on_axis": 35, "follower_force": 620, "moment": 1161, "slopes": 43
    },
    "cable12": {
        "mass": 40, "gravity": 26, "inertia_force": 84, "position": 40,
        "on_axis": 35, "follower_force": 330, "moment": 305, "slopes": 41
    },
    "cable18": {
        "mass": 105, "gravity": 42, "inertia_force": 198, "position": 85,
        "on_axis": 95, "follower_force": 636, "moment": 548, "slopes": 117
    },
    "beam12p": {
        "mass": 49, "gravity": 22, "inertia_force": 68, "position": 44,
        "on_axis": 35, "follower_force": 170, "moment": 63, "slopes": 42
    },
    "cable8p": {
        "mass": 40, "gravity": 22, "inertia_force": 56, "position": 33,
        "on_axis": 35, "follower_force": 170, "moment": 143, "slopes": 41
    },
    "beam24_continuum": {
        "stiffness": 217, "energy": 486, "elastic_force": 757, "elastic_tangent": 5125, "damping_force": 992,
        "damping_tangent": 8798, "dissipation": 693, "section_forces": 490,
        "discrete_force": 1110, "step_stiffness": 751, "algorithmic_force": 1020
    },
    "beam24_continuum_curved": {
        "stiffness_at": 1953, "energy": 1858, "elastic_force": 2129, "elastic_tangent": 12611, "section_forces": 4578,
        "discrete_force": 2510, "step_stiffness": 2095
    },
    "cable12_green_exact_curved": {
        "stiffness": 266, "energy": 310, "elastic_force": 735, "elastic_tangent": 2865, "section_forces": 608,
        "discrete_force": 1321
    },
    "cable12_engineering_exact_curved": {
        "stiffness": 266, "energy": 325, "elastic_force": 760, "elastic_tangent": 2940, "section_forces": 616,
        "discrete_force": 1341
    },
    "beam12p_continuum_curved": {
        "stiffness_at": 521, "energy": 572, "elastic_force": 656, "elastic_tangent": 2590, "section_forces": 616,
        "discrete_force": 823, "step_stiffness": 675
    },
    "cable12_engineering_exact_tension_only": {
        "stiffness": 0, "energy": 319, "elastic_force": 629, "elastic_tangent": 2164, "discrete_force": 1140,
        "section_forces": 290, "damping_force": 519, "damping_tangent": 1974, "dissipation": 394
    },
    "cable12_engineering_exact_tabulated": {
        "stiffness": 0, "energy": 260, "elastic_force": 505, "elastic_tangent": 1750, "discrete_force": 911,
        "section_forces": 260
    },
    "cable8p_engineering_exact_tabulated": {
        "stiffness": 0, "energy": 203, "elastic_force": 385, "elastic_tangent": 1059, "discrete_force": 704,
        "section_forces": 184
    },
    "cable8p_engineering_exact_tension_only": {
        "stiffness": 0, "energy": 262, "elastic_force": 509, "elastic_tangent": 1473, "discrete_force": 933,
        "section_forces": 214, "damping_force": 370, "damping_tangent": 1082, "dissipation": 286
    },
    "cable12_green_exact": {
        "stiffness": 0, "energy": 251, "elastic_force": 476, "elastic_tangent": 1681, "damping_force": 423,
        "damping_tangent": 1761, "dissipation": 301, "section_forces": 258,
        "discrete_force": 892, "step_stiffness": 161, "algorithmic_force": 439
    },
    "cable12_green_linear": {
        "stiffness": 0, "energy": 150, "elastic_force": 222, "elastic_tangent": 661, "section_forces": 156,
        "discrete_force": 407
    },
    "cable12_engineering_exact": {
        "stiffness": 0, "energy": 266, "elastic_force": 501, "elastic_tangent": 1741, "damping_force": 450,
        "damping_tangent": 1842, "dissipation": 325, "section_forces": 260,
        "discrete_force": 907, "algorithmic_force": 466
    },
    "cable12_engineering_linear": {
        "stiffness": 0, "energy": 165, "elastic_force": 257, "elastic_tangent": 746, "section_forces": 161,
        "discrete_force": 442
    },
    "cable12_green_exact_assumed": {
        "stiffness": 0, "energy": 280, "elastic_force": 510, "elastic_tangent": 2029, "section_forces": 361,
        "discrete_force": 956, "step_stiffness": 164
    },
    "cable12_green_linear_assumed": {
        "stiffness": 0, "energy": 156, "elastic_force": 223, "elastic_tangent": 778, "section_forces": 236,
        "discrete_force": 407
    },
    "cable12_engineering_exact_assumed": {
        "stiffness": 0, "energy": 295, "elastic_force": 525, "elastic_tangent": 2167, "section_forces": 377,
        "discrete_force": 981
    },
    "cable12_engineering_linear_assumed": {
        "stiffness": 0, "energy": 194, "elastic_force": 281, "elastic_tangent": 1172, "section_forces": 278,
        "discrete_force": 516
    },
    "cable18_green_exact": {
        "stiffness": 0, "energy": 410, "elastic_force": 788, "elastic_tangent": 5134, "damping_force": 1500,
        "damping_tangent": 9086, "dissipation": 1023, "section_forces": 516,
        "discrete_force": 1363, "step_stiffness": 980, "algorithmic_force": 1532
    },
    "cable18_engineering_exact": {
        "stiffness": 0, "energy": 425, "elastic_force": 813, "elastic_tangent": 5194, "damping_force": 1545,
        "damping_tangent": 9221, "dissipation": 1063, "section_forces": 518,
        "discrete_force": 1378, "algorithmic_force": 1577
    },
    "cable18_green_exact_assumed": {
        "stiffness": 0, "energy": 459, "elastic_force": 842, "elastic_tangent": 6608, "section_forces": 693,
        "discrete_force": 1467, "step_stiffness": 824
    },
    "cable18_engineering_exact_assumed": {
        "stiffness": 0, "energy": 474, "elastic_force": 857, "elastic_tangent": 6794, "section_forces": 709,
        "discrete_force": 1492
    },
    "beam12p_continuum": {
        "stiffness": 94, "energy": 219, "elastic_force": 303, "elastic_tangent": 1295, "damping_force": 396,
        "damping_tangent": 2126, "dissipation": 297, "section_forces": 144,
        "discrete_force": 455, "step_stiffness": 337, "algorithmic_force": 411
    },
    "cable8p_green_exact": {
        "stiffness": 0, "energy": 194, "elastic_force": 356, "elastic_tangent": 990, "damping_force": 286,
        "damping_tangent": 902, "dissipation": 205, "section_forces": 182,
        "discrete_force": 685, "step_stiffness": 127, "algorithmic_force": 298
    },
    "cable8p_green_linear": {
        "stiffness": 0, "energy": 112, "elastic_force": 154, "elastic_tangent": 351, "section_forces": 102,
        "discrete_force": 284
    },
    "cable8p_engineering_exact": {
        "stiffness": 0, "energy": 209, "elastic_force": 381, "elastic_tangent": 1050, "damping_force": 307,
        "damping_tangent": 959, "dissipation": 223, "section_forces": 184,
        "discrete_force": 700, "algorithmic_force": 319
    },
    "cable8p_engineering_linear": {
        "stiffness": 0, "energy": 127, "elastic_force": 189, "elastic_tangent": 436, "section_forces": 107,
        "discrete_force": 319
    },
    "cable8p_green_exact_assumed": {
        "stiffness": 0, "energy": 223, "elastic_force": 390, "elastic_tangent": 1177, "section_forces": 263,
        "discrete_force": 749, "step_stiffness": 131
    },
    "cable8p_green_linear_assumed": {
        "stiffness": 0, "energy": 122, "elastic_force": 163, "elastic_tangent": 431, "section_forces": 166,
        "discrete_force": 299
    },
    "cable8p_engineering_exact_assumed": {
        "stiffness": 0, "energy": 238, "elastic_force": 405, "elastic_tangent": 1279, "section_forces": 279,
        "discrete_force": 774
    },
    "cable8p_engineering_linear_assumed": {
        "stiffness": 0, "energy": 156, "elastic_force": 213, "elastic_tangent": 665, "section_forces": 202,
        "discrete_force": 393
    },
    "beam24_structural": {
        "stiffness": 360, "energy": 550, "elastic_force": 1084, "elastic_tangent": 7516, "damping_force": 1403,
        "damping_tangent": 14285, "dissipation": 919, "section_forces": 915
    },
    "beam12p_structural": {
        "stiffness": 133, "energy": 223, "elastic_force": 343, "elastic_tangent": 1266, "damping_force": 452,
        "damping_tangent": 2313, "dissipation": 329, "section_forces": 343
    },
    "rigid": {
        "place": 93, "point": 207, "wrench": 282, "inertia_force": 45, "inertia_tangent": 48, "kinetic_energy": 31,
        "discrete_point": 230, "frame": 48, "move": 93, "move_tangent": 82, "cayley_move": 43,
        "cayley_tangent": 16, "halfway": 26, "rate": 23, "increment": 24, "cayley_error": 51
    },
    "planar_rigid": {
        "place": 14, "point": 40, "wrench": 19, "inertia_force": 3, "inertia_tangent": 0, "kinetic_energy": 9,
        "discrete_point": 18, "frame": 0, "move": 17, "move_tangent": 0, "cayley_move": 22, "cayley_tangent": 4,
        "halfway": 15, "rate": 2, "increment": 3, "cayley_error": 3
    },
    "modal": {
        "inertia_force": 312, "mass_matrix": 105, "inertia_tangent": 675, "mode_force": 137, "mode_mass": 66,
        "mode_tangent": 459, "pair_tangent": 55, "kinetic_energy": 135, "potential_energy": 74, "attachment": 836,
        "attachment_mode": 151, "attachment_wrench": 463, "attachment_mode_wrench": 515, "attachment_pair_wrench": 164
    },
    "planar_modal": {
        "inertia_force": 71, "mass_matrix": 13, "inertia_tangent": 80, "mode_force": 31, "mode_mass": 7,
        "mode_tangent": 94, "pair_tangent": 14, "kinetic_energy": 32, "potential_energy": 13, "attachment": 107,
        "attachment_mode": 11, "attachment_wrench": 23, "attachment_mode_wrench": 37, "attachment_pair_wrench": 10
    },
    "slide_beam24_rigid": {"constraint": 599, "terms": 1646, "residual": 209, "tangent": 286, "discrete_gradient": 397},
    "slide_cable12_rigid": {
        "constraint": 472, "terms": 1429, "residual": 209, "tangent": 286,
        "discrete_gradient": 397
    },
    "slide_cable18_rigid": {
        "constraint": 698, "terms": 2198, "residual": 332, "tangent": 512,
        "discrete_gradient": 703
    },
    "slide_beam12p_planar_rigid": {
        "constraint": 156, "terms": 569, "residual": 97, "tangent": 113,
        "discrete_gradient": 193
    },
    "slide_cable8p_planar_rigid": {
        "constraint": 156, "terms": 569, "residual": 97, "tangent": 113,
        "discrete_gradient": 193
    },
    "slide_beam24_point": {
        "constraint": 536, "terms": 1373, "residual": 104, "tangent": 121, "discrete_gradient": 152
    },
    "slide_cable12_point": {
        "constraint": 409, "terms": 1156, "residual": 104, "tangent": 121, "discrete_gradient": 152
    },
    "slide_cable18_point": {
        "constraint": 635, "terms": 1925, "residual": 227, "tangent": 347, "discrete_gradient": 422
    },
    "slide_beam12p_planar_point": {
        "constraint": 150, "terms": 518, "residual": 82, "tangent": 98, "discrete_gradient": 136
    },
    "slide_cable8p_planar_point": {
        "constraint": 150, "terms": 518, "residual": 82, "tangent": 98, "discrete_gradient": 136
    },
    "slide_span_cable8p_planar_rigid": {"constraint": 156, "terms": 954, "residual": 184, "tangent": 698,
                                        "flowing_gradient": 323},
    "slide_span_cable8p_planar_point": {"constraint": 150, "terms": 903, "residual": 169, "tangent": 683,
                                        "flowing_gradient": 246},
    "slide_span_cable12_rigid": {"constraint": 472, "terms": 1880, "residual": 312, "tangent": 963,
                                 "flowing_gradient": 549},
    "slide_span_cable12_point": {"constraint": 409, "terms": 1607, "residual": 207, "tangent": 798,
                                 "flowing_gradient": 268},
    "frame": {"axes": 98, "motion": 458, "moment": 1238},
    "planar_frame": {"axes": 13, "motion": 50, "moment": 55},
    "joint_spherical": {"force": 0, "motion": 0, "discrete": 0},
    "joint_revolute": {"force": 274, "motion": 142},
    "joint_revolute_angle": {"force": 647, "motion": 447},
    "joint_universal": {"force": 119, "motion": 71},
    "joint_cylindrical": {"force": 404, "motion": 224},
    "joint_cylindrical_angle": {"force": 777, "motion": 529},
    "joint_cylindrical_distance": {"force": 476, "motion": 266},
    "joint_prismatic": {"force": 559, "motion": 295},
    "joint_prismatic_distance": {"force": 631, "motion": 337},
    "joint_weld": {"force": 429, "motion": 213},
    "joint_distance": {"force": 52, "motion": 30, "discrete": 21},
    "joint_aligned": {"force": 274, "motion": 142},
    "joint_locked": {"force": 429, "motion": 213},
    "joint_planar_spherical": {"force": 0, "motion": 0, "discrete": 0},
    "joint_planar_revolute_angle": {"force": 73, "motion": 141},
    "joint_planar_prismatic": {"force": 40, "motion": 38},
    "joint_planar_prismatic_distance": {"force": 60, "motion": 54},
    "joint_planar_weld": {"force": 25, "motion": 23},
    "joint_planar_distance": {"force": 27, "motion": 21, "discrete": 14},
    "joint_planar_locked": {"force": 25, "motion": 23},
    "joint_turning": {"force": 337, "motion": 305},
    "joint_sliding": {"force": 51, "motion": 42},
    "joint_turning_sliding": {"force": 397, "motion": 347},
    "joint_planar_turning": {"force": 73, "motion": 141},
    "joint_planar_sliding": {"force": 15, "motion": 16},
    "resistance": {"force": 338},
    "spring": {"energy": 10, "dissipation": 17, "force": 22, "tangent": 109, "discrete_force": 43},
    "zero_length_spring": {"energy": 7, "dissipation": 6, "force": 9, "tangent": 9, "discrete_force": 31},
    "planar_spring": {"energy": 8, "dissipation": 12, "force": 16, "tangent": 58, "discrete_force": 33},
    "planar_zero_length_spring": {"energy": 5, "dissipation": 4, "force": 6, "tangent": 6, "discrete_force": 21},
    "planar_resistance": {"force": 207},
    "drag": {"along_cable": 370, "force_along_cable": 47, "lift_along_cable": 341, "on_point": 31, "on_foil": 233,
             "on_section": 1103,
             "impulse_of_cable": 43, "inertia_of_cable": 214, "inertia_of_cable_tangent": 1607, "inertia_step": 166,
             "inertia_of_span": 218, "inertia_of_span_tangent": 2018,
             "impulse_of_point": 105, "inertia_of_point": 277, "inertia_of_point_tangent": 1455,
             "morison_of_cable": 186, "morison_of_cable_tangent": 377, "morison_of_point": 249,
             "morison_of_point_tangent": 693,
             "inertia_of_point_step": 768, "wet_sphere": 15, "wet_section": 19, "wet_column": 16, "wave_phase": 8,
             "wave_elevation": 7, "wave_stretching": 27, "wave_velocity": 98},
    "planar_drag": {"along_cable": 201, "force_along_cable": 35, "on_point": 20, "on_foil": 65,
                    "impulse_of_cable": 25, "inertia_of_cable": 128,
                    "inertia_of_cable_tangent": 663, "inertia_step": 105, "inertia_of_span": 131,
                    "inertia_of_span_tangent": 835, "impulse_of_point": 30,
                    "inertia_of_point": 117, "inertia_of_point_tangent": 371,
                    "morison_of_cable": 113, "morison_of_cable_tangent": 138, "morison_of_point": 103,
                    "morison_of_point_tangent": 148,
                    "inertia_of_point_step": 221, "wet_sphere": 15, "wet_section": 19, "wet_column": 16,
                    "wave_phase": 6, "wave_elevation": 6, "wave_stretching": 24, "wave_velocity": 63},
    "crossing": {"closest": 54, "contact": 84, "force": 1034, "motion": 112, "stretch": 356, "sticking": 3950,
                 "sliding": 7752, "step": 129, "turned": 69},
    "planar_crossing": {"closest": 12, "contact": 59, "force": 309, "motion": 24, "stretch": 97, "sticking": 523,
                        "sliding": 324, "step": 101, "turned": 56},
    "surface": {"flat": 5, "rounded": 61, "terrain": 116, "push": 12, "push_hertz": 29, "frictionless": 90,
                "sticking": 185, "sliding": 468, "slipping": 675, "reaction": 276, "motion": 91, "slip": 123},
    "planar_surface": {"flat": 3, "rounded": 33, "terrain": 35, "push": 12, "push_hertz": 29, "frictionless": 40,
                       "sticking": 89, "sliding": 170, "slipping": 255, "reaction": 85, "motion": 40, "slip": 48},
    "span_cable8p": {
        "point": 105, "kinetic_energy": 137, "inertia": 257, "mass_matrix": 118, "inertia_tangent": 1138, "weight": 63,
        "energy": 238, "elastic_force": 439, "elastic_tangent": 1551, "dissipation": 267, "damping_force": 365,
        "damping_tangent": 2171, "momentum": 113, "momentum_energy": 26, "momentum_step": 740, "elastic_step": 1212,
        "line_force": 84, "line_force_tangent": 661, "stored_force": 54,
        "stored_force_tangent": 159, "share": 11, "point_tangent": 144, "motion": 255, "kinetic_force": 303,
        "kinetic_force_tangent": 3550
    },
    "span_cable12": {
        "point": 148, "kinetic_energy": 199, "inertia": 373, "mass_matrix": 172, "inertia_tangent": 1574, "weight": 79,
        "energy": 295, "elastic_force": 561, "elastic_tangent": 2582, "dissipation": 391, "damping_force": 538,
        "damping_tangent": 4371, "momentum": 169, "momentum_energy": 38, "momentum_step": 977, "elastic_step": 1543,
        "line_force": 116, "line_force_tangent": 1269, "stored_force": 67,
        "stored_force_tangent": 268, "share": 11, "point_tangent": 188, "motion": 364, "kinetic_force": 415,
        "kinetic_force_tangent": 6988
    },
    "planar_branch": {"measures": 14, "force": 44, "tangent": 260, "hold": 12, "slide": 32},
    "branch": {"measures": 49, "force": 287, "tangent": 2750, "hold": 24, "slide": 70},
    "planar_working_curve": {"measure": 8, "change": 21, "force": 14, "tangent": 54},
    "working_curve": {"measure": 10, "change": 21, "force": 20, "tangent": 104},
    "planar_rope_point": {"point": 357, "wrench": 776, "discrete_point": 392, "slope": 294, "slope_stiffness": 519},
    "rope_point": {"point": 402, "wrench": 844, "discrete_point": 297, "slope": 341, "slope_stiffness": 607},
    "planar_taut_rope": {
        "straight": 43, "straight_tangent": 135, "free_length": 12, "tension": 24, "tension_tangent": 70, "energy": 13,
        "slide": 29, "slide_tangent": 33
    },
    "taut_part": {"feet": 498, "moves": 782, "tangent": 5512, "spin": 29, "spin_tangent": 167},
    "tangent_point": {"conditions": 1744, "motion": 325, "chord": 202, "across": 27, "turned_conditions": 2017,
                      "turned_motion": 369, "turned_acc": 4, "wrap_energy": 93, "wrap_inertia": 616, "wrap_mass": 183,
                      "wrap_weight": 63, "laid_weight": 139, "ring": 22, "momentum": 62, "momentum_energy": 8,
                      "momentum_step": 371, "by_products": 119, "chord_step": 63, "store_step": 214, "laid_step": 55},
    "planar_sheave": {
        "tangent_point": 27, "tangent_point_motion": 26, "angle": 121, "energy": 13, "weight": 21, "force": 85,
        "tangent": 204, "kinetic_energy": 60, "inertia": 213, "mass_matrix": 162, "inertia_tangent": 1099,
        "dissipation": 15, "damping_force": 16, "damping_tangent": 50,
        "friction": 66, "friction_tangent": 367, "friction_on": 65, "friction_on_tangent": 351, "friction_off": 65,
        "friction_off_tangent": 351, "friction_short": 70, "friction_short_tangent": 342,
        "coulomb": 52, "coulomb_tangent": 255, "coulomb_motion": 31, "coulomb_on": 52, "coulomb_on_tangent": 244,
        "coulomb_on_motion": 32, "coulomb_off": 52, "coulomb_off_tangent": 244, "coulomb_off_motion": 32,
        "coulomb_short": 57, "coulomb_short_tangent": 247, "coulomb_short_motion": 31,
        "short_wrap": 399, "short_wrap_motion": 52,
        "winding": 46, "winding_motion": 29, "store": 69, "store_mass": 5, "store_tangent": 71, "store_energy": 15,
        "laying": 9,
        "creep": 17, "momentum": 16, "momentum_energy": 6, "momentum_step": 133, "store_step": 61
    },
}
