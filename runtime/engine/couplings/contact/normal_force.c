/* The normal force of contact at a penetration, by the kernels of derive/couplings/surface.py. */
#include "couplings/contact/contact.h"

fu_normal_force fu_normal_force_at(const fu_contact *contact, double depth, double rate, double depth_next)
{
    fu_normal_force of;
    const double law[2] = {contact->law.stiffness, contact->law.damping};
    const fu_surface_kernels *kernel = contact->surface.kernel;
    (contact->law.hertz ? kernel->push_hertz : kernel->push)(depth, rate, law, depth_next, &of.p, &of.by_depth,
                                                             &of.by_rate, &of.elastic, &of.energy, &of.mean);
    if (of.p < 0.0) of.p = of.by_depth = of.by_rate = 0.0; /* damping never pulls */
    return of;
}
