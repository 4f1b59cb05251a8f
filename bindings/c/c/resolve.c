/* Three robots that pass through one place: the first conflict of each, the earliest start of one, the times at which the place
 * is free, a plan for all, and another path for one of them. */
#include "pcr.h"
#include <stdio.h>

/* Room for 3 agents of one leg, for one more leg and three phases while an agent is replaced, and for the table. */
static PcrSegmentStorage segments[4];
static PcrPhaseStorage phases[12];
static PcrMotionStorage motions[3], room[3];
static PcrRegionStorage entries[8];
static PcrPieceStorage pieces[8];
static PcrFleet fleet;

static const PcrPathSegment line[] = {{PCR_LINE, 4.0f, 0.0f}};

static int failed(const char *what, PcrStatus status) {
  if (status == PCR_STATUS_OK) return 0;
  printf("%s: status %d\n", what, (int)status);
  return 1;
}

/* Prints the first conflict of each robot; returns the number of robots that have one. */
static int conflicts(void) {
  int meeting = 0;
  for (size_t ego = 0; ego < pcr_fleet_agents(&fleet); ego++) {
    PcrAgentConflict met;
    bool found = false;
    if (failed("first conflict", pcr_fleet_first_conflict(&fleet, ego, false, &met, &found))) return -1;
    if (!found) continue;
    printf("agent %u meets agent %u first, at %.3f s\n", (unsigned)ego, (unsigned)met.other, met.conflict.time.lo);
    meeting++;
  }
  return meeting;
}

int main(void) {
  const PcrMemory memory = {
      .segments = segments, .segment_count = 4,
      .phases = phases, .phase_count = 12,
      .motions = motions, .motion_count = 3,
      .entries = entries, .entry_count = 8,
      .pieces = pieces, .piece_count = 8,
  };
  /* West to east, south to north, and north to south in the other's way. */
  PcrAgent agents[] = {
      {.x = -2.0f, .y = 0.0f, .heading = 0.0f, .radius = 0.25f, .start = 0.0f,
       .legs = line, .leg_count = 1, .speed = 1.0f, .acceleration = 1.0f},
      {.x = 0.0f, .y = -2.0f, .heading = 1.5707963f, .radius = 0.25f, .start = 0.0f,
       .legs = line, .leg_count = 1, .speed = 1.0f, .acceleration = 1.0f},
      {.x = 0.0f, .y = 2.0f, .heading = -1.5707963f, .radius = 0.25f, .start = 0.0f,
       .legs = line, .leg_count = 1, .speed = 1.0f, .acceleration = 1.0f},
  };
  const PcrInterval place = {2.0f, 2.0f}, times = {0.0f, 9.0f};
  PcrInterval safe[4];
  PcrPlanError why;
  size_t count = 0, order[] = {0, 1, 2};
  float delay = 0.0f;

  if (failed("init", pcr_fleet_init(&fleet, &memory))) return 1;
  for (size_t k = 0; k < 3; k++)
    if (failed("add", pcr_fleet_add(&fleet, &agents[k]))) return 1;
  if (pcr_fleet_earliest_start(&fleet, 1, 0.0f, &delay) != PCR_STATUS_NOT_BUILT) return 1;
  if (failed("build", pcr_fleet_build(&fleet))) return 1;
  if (conflicts() != 3) return 1;

  if (failed("safe intervals", pcr_fleet_safe_intervals(&fleet, 0, place, times, safe, 4, &count))) return 1;
  for (size_t k = 0; k < count; k++) printf("agent 0 is safe in the middle from %.3f to %.3f s\n", safe[k].lo, safe[k].hi);

  if (pcr_fleet_plan_delays(&fleet, order, 3, room, 3, &why) != PCR_STATUS_NO_PLAN) return 1;
  printf("no plan: reason %d, agents %u and %u\n", (int)why.reason, (unsigned)why.agents[0], (unsigned)why.agents[1]);

  agents[2].x = 1.0f; /* in a lane of its own */
  if (failed("replace", pcr_fleet_replace(&fleet, 2, &agents[2]))) return 1;
  printf("agent 2 takes another lane\n");
  if (failed("earliest start", pcr_fleet_earliest_start(&fleet, 1, 0.0f, &delay))) return 1;
  printf("agent 1 may set off after %.3f s\n", delay);
  if (failed("plan", pcr_fleet_plan_delays(&fleet, order, 3, room, 3, &why))) return 1;
  if (conflicts() != 0) return 1;
  printf("planned: nobody meets anybody\n");
  return 0;
}
