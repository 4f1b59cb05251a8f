/* One robot that computes its own hold, in fixed point: only the code that prints uses floating-point instructions. The robot knows
 * its row, which robot goes first, and the reports of the other one. */
#include "pcr_q16.h"
#include <stdio.h>

static PcrQ16SegmentStorage segments[3];
static PcrQ16PhaseStorage phases[6];
static PcrQ16MotionStorage motions[2];
static PcrQ16RegionStorage entries[2];
static PcrQ16PieceStorage pieces[4];
static PcrQ16PrecedenceStorage orders[2];
static PcrQ16CheckStorage robots[2];
static PcrQ16Fleet fleet;

static const PcrQ16PathSegment east[] = {{PCR_LINE, PCR_Q16(4.0), 0}};
static const PcrQ16PathSegment north[] = {{PCR_LEFT, PCR_Q16(1.5707963), PCR_Q16(1.0)}, {PCR_LINE, PCR_Q16(3.0), 0}};

static double metres(int32_t number) { return number / 65536.0; }

static int hold(void) {
  PcrQ16MovementAuthority found;
  PcrStatus status = pcr_q16_fleet_hold(&fleet, 1, &found);
  if (status != PCR_STATUS_OK) return 1;
  printf("robot 1 may go to %.3f m%s\n", metres(found.length), found.kind == PCR_AUTHORITY_KIND_FREE ? ", the end" : "");
  return 0;
}

int main(void) {
  const PcrQ16Memory memory = {
      .segments = segments, .segment_count = 3,
      .phases = phases, .phase_count = 6,
      .motions = motions, .motion_count = 2,
      .entries = entries, .entry_count = 2,
      .pieces = pieces, .piece_count = 4,
      .orders = orders, .order_count = 2, .robots = robots,
  };
  const int32_t radius = PCR_Q16(0.25), one = PCR_Q16(1.0);
  const PcrQ16Agent agents[] = {
      {.x = PCR_Q16(-2.0), .y = 0, .heading = 0, .radius = radius, .start = 0,
       .legs = east, .leg_count = 1, .speed = one, .acceleration = one},
      {.x = PCR_Q16(-1.0), .y = PCR_Q16(-2.0), .heading = PCR_Q16_RADIANS(0.0), .radius = radius, .start = 0,
       .legs = north, .leg_count = 2, .speed = one, .acceleration = one},
  };
  if (pcr_q16_fleet_init(&fleet, &memory) != PCR_STATUS_OK) return 1;
  for (size_t k = 0; k < 2; k++)
    if (pcr_q16_fleet_add(&fleet, &agents[k]) != PCR_STATUS_OK) return 1;
  if (pcr_q16_fleet_build_row(&fleet, 1) != PCR_STATUS_OK) return 1;
  if (pcr_q16_fleet_decide(&fleet, 1, 0, PCR_SECOND) != PCR_STATUS_OK || hold()) return 1;
  for (int32_t at = PCR_Q16(1.0); at <= PCR_Q16(3.0); at += PCR_Q16(0.5)) {
    const PcrQ16Progress progress = {{at, at}, at};
    printf("robot 0 reports %.3f m\n", metres(at));
    if (pcr_q16_fleet_report(&fleet, 0, &progress) != PCR_STATUS_OK || hold()) return 1;
  }
  return 0;
}
