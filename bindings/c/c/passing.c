/* Three robots that keep passing orders, however late they are: orders from a plan, a hold for each robot, a new mission that is
 * admitted, one that is refused, and a robot that computes its own hold from its own row. */
#include "pcr.h"
#include <stdio.h>

/* Room for 3 agents of one leg and one more while an agent is replaced; orders for all regions, and as many again. */
static PcrSegmentStorage segments[4];
static PcrPhaseStorage phases[12];
static PcrMotionStorage motions[3];
static PcrRegionStorage entries[8];
static PcrPieceStorage pieces[8];
static PcrPrecedenceStorage orders[8];
static PcrCheckStorage robots[3];
static PcrFleet fleet;

static const PcrPathSegment line[] = {{PCR_LINE, 4.0f, 0.0f}};
static const PcrBrakingModel brakes = {0.5f, 0.1f};

static int failed(const char *what, PcrStatus status) {
  if (status == PCR_STATUS_OK) return 0;
  printf("%s: status %d\n", what, (int)status);
  return 1;
}

/* Prints how far each robot may go now, and how fast it may be at its start. */
static int holds(void) {
  for (size_t agent = 0; agent < pcr_fleet_agents(&fleet); agent++) {
    PcrMovementAuthority hold;
    float speed = 0.0f;
    if (failed("hold", pcr_fleet_hold(&fleet, agent, &hold))) return 1;
    if (hold.kind == PCR_AUTHORITY_KIND_INSIDE) return 1;
    if (failed("speed", pcr_stopping_speed(&brakes, hold.length, &speed))) return 1;
    printf("agent %u may go to %.3f m%s, at %.3f m/s\n", (unsigned)agent, hold.length,
           hold.kind == PCR_AUTHORITY_KIND_FREE ? ", the end" : "", speed);
  }
  return 0;
}

/* A robot that stands. One that moves reports as `stop` the hold that it was told. */
static PcrProgress at(float length) { return (PcrProgress){{length, length}, length}; }

int main(void) {
  const PcrMemory memory = {
      .segments = segments, .segment_count = 4,
      .phases = phases, .phase_count = 12,
      .motions = motions, .motion_count = 3,
      .entries = entries, .entry_count = 8,
      .pieces = pieces, .piece_count = 8,
      .orders = orders, .order_count = 8, .robots = robots,
  };
  /* West to east; south to north, 3 s later; and one that stands aside. */
  const PcrAgent agents[] = {
      {.x = -2.0f, .y = 0.0f, .heading = 0.0f, .radius = 0.25f, .start = 0.0f,
       .legs = line, .leg_count = 1, .speed = 1.0f, .acceleration = 1.0f},
      {.x = 0.0f, .y = -2.0f, .heading = 1.5707963f, .radius = 0.25f, .start = 3.0f,
       .legs = line, .leg_count = 1, .speed = 1.0f, .acceleration = 1.0f},
      {.x = 1.0f, .y = 2.0f, .heading = -1.5707963f, .radius = 0.25f, .start = 0.0f, .speed = 1.0f, .acceleration = 1.0f},
  };
  const PcrCheckTolerances tolerances = {0.01f, 0.001f};
  const PcrProgress start = at(0.0f);
  PcrAgent mission = agents[2];
  PcrProgress progress;
  PcrAdmissionError why;
  PcrMovementAuthority own;

  if (failed("init", pcr_fleet_init(&fleet, &memory))) return 1;
  for (size_t k = 0; k < 3; k++)
    if (failed("add", pcr_fleet_add(&fleet, &agents[k]))) return 1;
  if (failed("build", pcr_fleet_build(&fleet))) return 1;
  if (failed("orders", pcr_fleet_orders_as_planned(&fleet, &why))) return 1;
  if (failed("check", pcr_fleet_check(&fleet, &tolerances, &why))) return 1;
  if (holds()) return 1;

  printf("agent 2 gets a mission\n");
  mission.legs = line;
  mission.leg_count = 1;
  if (failed("admit", pcr_fleet_admit(&fleet, 2, &mission, &start, &tolerances, NULL, &why))) return 1;
  if (holds()) return 1;

  mission.x = 0.0f; /* down the lane on which agent 1 comes up */
  if (pcr_fleet_admit(&fleet, 2, &mission, &start, &tolerances, NULL, &why) != PCR_STATUS_REFUSED) return 1;
  printf("another one is refused: reason %d, agents %u and %u\n", (int)why.reason, (unsigned)why.agents[0],
         (unsigned)why.agents[1]);

  printf("agent 0 is at 2.600 m\n");
  progress = at(2.6f);
  if (failed("report", pcr_fleet_report(&fleet, 0, &progress))) return 1;
  progress = at(1.0f); /* an old report that comes late changes nothing */
  if (failed("report", pcr_fleet_report(&fleet, 0, &progress))) return 1;
  if (holds()) return 1;

  if (failed("row", pcr_fleet_build_row(&fleet, 1))) return 1;
  if (failed("decide", pcr_fleet_decide(&fleet, 1, 0, PCR_SECOND))) return 1;
  if (failed("hold", pcr_fleet_hold(&fleet, 1, &own))) return 1;
  printf("agent 1 by itself: %s\n", own.kind == PCR_AUTHORITY_KIND_FREE ? "free" : "held");
  if (pcr_fleet_hold(&fleet, 0, &own) != PCR_STATUS_ONLY_ROW) return 1;

  if (failed("remove", pcr_fleet_remove(&fleet, 0))) return 1;
  printf("%u agents are left\n", (unsigned)pcr_fleet_agents(&fleet));
  return 0;
}
