/* Public: tension-only cables that become slack and taut: events/slack_cables.c. */
#ifndef FUNICULAR_EVENTS_SLACK_CABLES_H
#define FUNICULAR_EVENTS_SLACK_CABLES_H

#include "base/common.h"

#define FU_SLACK_STRAIN 1e-9 /* smaller compressions are not slack, since they may be rounding */

/* Of a cable: the least axial strain in the middle of its elements at `now`; whether any is slack; the first, or last,
 * slack one; the unreported change: 1 some are slack, -1 none is any more, 0 none; and its time, s. */
struct fu_slackness {
    double least, at;
    int is_slack, element, pending;
};

void fu_begin_slackness(fu_run *run);
void fu_note_slackness(fu_run *run, double h);
int fu_take_slackness(fu_run *run, double before);
int fu_possible_slackness(const fu_run *run);

#endif
