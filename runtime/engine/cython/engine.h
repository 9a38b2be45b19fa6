/* The engine: what is integrated, and the work space of integrating it.
 *
 * Coordinates. q is the configuration: for each cable its nodal vectors node by node, then for each body position and
 * attitude (unit quaternion; in the plane unit complex number) and, of a modal one, the coordinates of its modes. v, accelerations and increments have one entry a degree
 * of freedom (dof): the cables' as in q, then the bodies' (translation; rotation about body axes; modes).
 *
 * Unknowns of a linear system: the free coordinates of the cables ("band"), then the border: those of nodes where cables
 * meet, if that is cheaper (model/numbering.py), those of the bodies, then what each joint and spring adds. Supports make
 * dofs linear in the unknowns, dofs = T unknowns + what motions prescribe; unknown_of_dof[dof] is the number of the unknown
 * that the dof is, -1 where it is fixed or prescribed, -2 - k where it is the k-th combination of unknowns
 * (linear/unknowns.c).
 *
 * Every array belongs to the caller; nothing here allocates.
 */
#ifndef FUNICULAR_ENGINE_H
#define FUNICULAR_ENGINE_H

#include "acceleration.h"
#include "attachments.h"
#include "bodies.h"
#include "boundaries.h"
#include "cables.h"
#include "checkpoint.h"
#include "common.h"
#include "constraints.h"
#include "contacts.h"
#include "coupling.h"
#include "coupling_events.h"
#include "couplings.h"
#include "crossings.h"
#include "drags.h"
#include "end_stops.h"
#include "energy_balance.h"
#include "equations.h"
#include "events.h"
#include "passages.h"
#include "slack_cables.h"
#include "failure.h"
#include "hard_contacts.h"
#include "integrator.h"
#include "joints.h"
#include "linear.h"
#include "loads.h"
#include "model.h"
#include "motions.h"
#include "newton.h"
#include "part_timing.h"
#include "penalty_friction.h"
#include "point_force.h"
#include "projection.h"
#include "proximity.h"
#include "record.h"
#include "resistances.h"
#include "rotation.h"
#include "run.h"
#include "slides.h"
#include "state.h"
#include "surfaces.h"
#include "threads.h"
#include "unknowns.h"

#endif
