/* Vehicles as they are: two trucks pass each other 1 mm apart, and a forklift turns in place and backs out in reverse gear. */
#include "pcr.h"
#include <stdio.h>

static PcrSegmentStorage segments[8];
static PcrPhaseStorage phases[12];
static PcrMotionStorage motions[4];
static PcrRegionStorage entries[8];
static PcrPieceStorage pieces[32];
static PcrCornerStorage corners[16];
static PcrFleet fleet;

/* 1.2 m long and 0.8 m wide, with the reference point in the middle. */
static const PcrCorner truck[] = {{-0.6f, -0.4f}, {0.6f, -0.4f}, {0.6f, 0.4f}, {-0.6f, 0.4f}};
/* Its reference point is 0.3 m before its rear. */
static const PcrCorner forklift[] = {{-0.3f, -0.4f}, {1.2f, -0.4f}, {1.2f, 0.4f}, {-0.3f, 0.4f}};

static const PcrPathSegment lane[] = {{PCR_LINE, 6.0f, 0.0f}};
/* Ahead, a quarter turn to the left on the spot with a lever of 1 m, and back. */
static const PcrPathSegment docking[] = {
    {PCR_LINE, 1.0f, 0.0f}, {PCR_PIVOT_LEFT, 1.5707963f, 1.0f}, {PCR_REVERSE, 0.0f, 0.0f}, {PCR_LINE, 2.0f, 0.0f}};

static int failed(const char *what, PcrStatus status) {
  if (status == PCR_STATUS_OK) return 0;
  printf("%s: %s, %s\n", what, pcr_status_name(status), pcr_status_text(status));
  return 1;
}

int main(void) {
  const PcrMemory memory = {
      .segments = segments, .segment_count = 8,
      .phases = phases, .phase_count = 12,
      .motions = motions, .motion_count = 4,
      .entries = entries, .entry_count = 8,
      .pieces = pieces, .piece_count = 32,
      .corners = corners, .corner_count = 16,
  };
  PcrAgent agents[] = {
      {.x = 0.0f, .y = 0.0f, .heading = 0.0f, .legs = lane, .leg_count = 1, .speed = 1.0f, .acceleration = 1.0f,
       .corners = truck, .corner_count = 4},
      {.x = 6.0f, .y = 0.801f, .heading = 3.1415927f, .legs = lane, .leg_count = 1, .speed = 1.0f, .acceleration = 1.0f,
       .corners = truck, .corner_count = 4},
      {.x = 2.0f, .y = -1.5f, .heading = 0.0f, .legs = docking, .leg_count = 4, .speed = 1.0f, .acceleration = 1.0f,
       .corners = forklift, .corner_count = 4},
  };
  PcrInputError error;
  if (failed("init", pcr_fleet_init(&fleet, &memory))) return 1;
  for (size_t k = 0; k < 3; k++)
    if (failed("add", pcr_fleet_add(&fleet, &agents[k]))) return 1;
  if (failed("build", pcr_fleet_build(&fleet))) return 1;
  for (size_t ego = 0; ego < pcr_fleet_agents(&fleet); ego++) {
    PcrRegion regions[8];
    size_t count = 0;
    if (failed("regions", pcr_fleet_regions(&fleet, ego, regions, 8, &count))) return 1;
    printf("agent %u has %u regions\n", (unsigned)ego, (unsigned)count);
    for (size_t k = 0; k < count; k++) {
      const PcrRegion *r = &regions[k];
      printf("  with agent %u, %.2f..%.2f m from %.2f to %.2f s\n", r->other, r->length.lo, r->length.hi, r->time.lo, r->time.hi);
    }
  }
  agents[0].radius = -0.1f;
  if (pcr_fleet_add(&fleet, &agents[0]) == PCR_STATUS_OK) return 1;
  if (failed("error", pcr_fleet_input_error(&fleet, &error))) return 1;
  printf("refused: %s: %s\n", error.field, pcr_status_text(error.status));
  return 0;
}
