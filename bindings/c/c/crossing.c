/* Two robots that cross: their collision regions, the conflict of their motions, and a delay that resolves it. */
#include "pcr.h"
#include <stdio.h>

/* Room for 2 agents of up to 2 legs, and for the table. All of it belongs to the fleet from pcr_fleet_init on. */
static PcrSegmentStorage segments[4];
static PcrPhaseStorage phases[6];
static PcrMotionStorage motions[2];
static PcrRegionStorage entries[4];
static PcrPieceStorage pieces[8];
static PcrFleet fleet;

static const PcrPathSegment east[] = {{PCR_LINE, 4.0f, 0.0f}};
/* A quarter circle to the left, then straight on. */
static const PcrPathSegment north[] = {{PCR_LEFT, 1.5707963f, 1.0f}, {PCR_LINE, 3.0f, 0.0f}};

static int failed(const char *what, PcrStatus status) {
  if (status == PCR_STATUS_OK) return 0;
  printf("%s: status %d\n", what, (int)status);
  return 1;
}

static int conflicts(void) {
  PcrConflict found[4];
  size_t count = 0;
  if (failed("conflicts", pcr_fleet_conflicts(&fleet, 0, 1, found, 4, &count))) return -1;
  for (size_t k = 0; k < count; k++)
    printf("conflict from %.3f s to %.3f s, %.3f m deep\n", found[k].time.lo, found[k].time.hi, found[k].depth);
  return (int)count;
}

int main(void) {
  const PcrMemory memory = {
      .segments = segments, .segment_count = 4,
      .phases = phases, .phase_count = 6,
      .motions = motions, .motion_count = 2,
      .entries = entries, .entry_count = 4,
      .pieces = pieces, .piece_count = 8,
  };
  const PcrAgent agents[] = {
      {.x = -2.0f, .y = 0.0f, .heading = 0.0f, .radius = 0.25f, .start = 0.0f,
       .legs = east, .leg_count = 1, .speed = 1.0f, .acceleration = 1.0f},
      {.x = -1.0f, .y = -2.0f, .heading = 0.0f, .radius = 0.25f, .start = 0.0f,
       .legs = north, .leg_count = 2, .speed = 1.0f, .acceleration = 1.0f},
  };
  if (failed("init", pcr_fleet_init(&fleet, &memory))) return 1;
  for (size_t k = 0; k < 2; k++)
    if (failed("add", pcr_fleet_add(&fleet, &agents[k]))) return 1;
  if (failed("build", pcr_fleet_build(&fleet))) return 1;

  for (size_t ego = 0; ego < pcr_fleet_agents(&fleet); ego++) {
    PcrRegion regions[4];
    size_t count = 0;
    if (failed("regions", pcr_fleet_regions(&fleet, ego, regions, 4, &count))) return 1;
    for (size_t k = 0; k < count; k++) {
      const PcrRegion *r = &regions[k];
      printf("agent %u keeps out of %.3f..%.3f m from %.3f to %.3f s because of agent %u\n", r->ego, r->length.lo,
             r->length.hi, r->time.lo, r->time.hi, r->other);
    }
  }
  if (conflicts() != 1) return 1;
  printf("agent 1 sets off 1.5 s later\n");
  if (failed("delay", pcr_fleet_delay(&fleet, 1, 1.5f))) return 1;
  if (conflicts() != 0) return 1;
  printf("no conflict\n");
  return 0;
}
