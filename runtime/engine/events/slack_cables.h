/* Cables that give way in compression, where they become slack and taut: events/slack_cables.c. */
#ifndef FUNICULAR_EVENTS_SLACK_CABLES_H
#define FUNICULAR_EVENTS_SLACK_CABLES_H

#include "base/common.h"

#define FU_SLACK_STRAIN 1e-9 /* what is compressed by less is not slack, lest rounding say so */

/* Of a cable: the least axial strain in the middle of its elements at `now`; whether any is slack; the one that was
 * first, or last, slack; what the caller is to learn: 1 that some are slack, -1 that none is any more, 0 nothing; and
 * when that was, s. */
struct fu_slackness {
    double least, at;
    int is_slack, element, pending;
};

void fu_begin_slackness(fu_run *run);
void fu_note_slackness(fu_run *run, double h);
int fu_take_slackness(fu_run *run, double before);
int fu_possible_slackness(const fu_run *run);

#endif
