/* Collision regions of discs on line/arc paths. Made by cbindgen from bindings/c/src: see bindings/c/tests/header.rs. */

#ifndef PCR_H
#define PCR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 `PcrLeg.curve` of a straight line.
 */
#define PCR_LINE 0

/*
 `PcrLeg.curve` of an arc that turns left, counter-clockwise.
 */
#define PCR_LEFT 1

/*
 `PcrLeg.curve` of an arc that turns right, clockwise.
 */
#define PCR_RIGHT 2

/*
 What a call comes to. Whatever fails leaves the fleet as it was; a table that became full is empty.
 */
typedef enum PcrStatus {
  /*
   Done.
   */
  PCR_STATUS_OK = 0,
  /*
   A pointer is null.
   */
  PCR_STATUS_NULL,
  /*
   A number is NaN or infinite.
   */
  PCR_STATUS_NON_FINITE,
  /*
   A number is below 0 that must not be.
   */
  PCR_STATUS_NEGATIVE,
  /*
   A number must be above 0.
   */
  PCR_STATUS_NON_POSITIVE,
  /*
   A number is beyond a million in magnitude, or a path or a motion gets there.
   */
  PCR_STATUS_OUT_OF_RANGE,
  /*
   An arc sweeps more than one turn: split it.
   */
  PCR_STATUS_SWEEP_OVER_ONE_TURN,
  /*
   The profile does not travel the length of the path.
   */
  PCR_STATUS_LENGTH_MISMATCH,
  /*
   A leg is neither a line nor an arc.
   */
  PCR_STATUS_NO_SUCH_CURVE,
  /*
   There is no agent of that number.
   */
  PCR_STATUS_NO_SUCH_AGENT,
  /*
   The memory has no room for another agent, or for its segments or phases.
   */
  PCR_STATUS_NO_ROOM,
  /*
   The table has no room for the entries or the pieces of all regions.
   */
  PCR_STATUS_TABLE_FULL,
  /*
   The buffer is too small; the count that is needed is told.
   */
  PCR_STATUS_BUFFER_TOO_SMALL,
  /*
   The table is not that of the agents: `pcr_fleet_build` was not called since the last was added.
   */
  PCR_STATUS_NOT_BUILT,
  /*
   The order does not list each agent once.
   */
  PCR_STATUS_BAD_ORDER,
  /*
   There is no such plan: whoever waits, for however long, meets another one.
   */
  PCR_STATUS_NO_PLAN,
} PcrStatus;

/*
 Why there is no plan.
 */
typedef enum PcrReason {
  /*
   The two overlap at the starts of their paths.
   */
  PCR_REASON_STARTS,
  /*
   The two overlap at the ends of their paths.
   */
  PCR_REASON_ENDS,
  /*
   The two meet however late either sets off.
   */
  PCR_REASON_ALWAYS,
  /*
   The first cannot go because of the second, with the orders that were tried.
   */
  PCR_REASON_ORDER,
  /*
   The check of the plan found that the two overlap.
   */
  PCR_REASON_OVERLAP,
  /*
   The times of the first are out of range.
   */
  PCR_REASON_TIMES,
} PcrReason;

/*
 A fleet and the table of its regions.
 */
typedef struct PcrFleet {
  size_t opaque[24];
} PcrFleet;

/*
 Room for a segment of a path: one a leg, or one for an agent that stands.
 */
typedef struct PcrSegment {
  float opaque[30];
} PcrSegment;

/*
 Room for a phase of a profile: three an agent, or one a stretch.
 */
typedef struct PcrPhase {
  float opaque[7];
} PcrPhase;

/*
 Room for the motion of an agent.
 */
typedef struct PcrMotion {
  size_t pointers[4];
  float opaque[14];
} PcrMotion;

/*
 Room for a region in the table; each serves both agents of its pair.
 */
typedef struct PcrEntry {
  uint32_t opaque[2];
} PcrEntry;

/*
 Room for a piece of a region: what one segment of either path has to do with it.
 */
typedef struct PcrPiece {
  uint32_t opaque[7];
} PcrPiece;

/*
 Memory for a fleet. It belongs to the fleet from `pcr_fleet_init` on.
 */
typedef struct PcrMemory {
  /*
   For the paths.
   */
  struct PcrSegment *segments;
  /*
   Number of them.
   */
  size_t segment_count;
  /*
   For the profiles.
   */
  struct PcrPhase *phases;
  /*
   Number of them.
   */
  size_t phase_count;
  /*
   For the agents.
   */
  struct PcrMotion *motions;
  /*
   Number of them: the most agents.
   */
  size_t motion_count;
  /*
   For the regions.
   */
  struct PcrEntry *entries;
  /*
   Number of them.
   */
  size_t entry_count;
  /*
   For the pieces of the regions.
   */
  struct PcrPiece *pieces;
  /*
   Number of them.
   */
  size_t piece_count;
} PcrMemory;

/*
 A line or an arc of a path; it begins in the pose in which the one before it ends.
 */
typedef struct PcrLeg {
  /*
   PCR_LINE, PCR_LEFT or PCR_RIGHT.
   */
  uint8_t curve;
  /*
   Length (m), of an arc at most one turn; 0 adds nothing.
   */
  float length;
  /*
   Radius of an arc (m), above 0; of a line it is not looked at.
   */
  float radius;
} PcrLeg;

/*
 Motion at constant acceleration, part of a profile.
 */
typedef struct PcrStretch {
  /*
   In s.
   */
  float duration;
  /*
   In m/s².
   */
  float acceleration;
} PcrStretch;

/*
 A disc, its path and its motion along it.
 */
typedef struct PcrAgent {
  /*
   Position at the start of the path (m).
   */
  float x;
  /*
   In m.
   */
  float y;
  /*
   Direction of travel there (rad).
   */
  float heading;
  /*
   Of the disc (m), above 0.
   */
  float radius;
  /*
   When it sets off (s); it stands before, and after its arrival.
   */
  float start;
  /*
   The path; none for an agent that stands.
   */
  const struct PcrLeg *legs;
  /*
   Number of legs.
   */
  size_t leg_count;
  /*
   Largest speed of a motion from rest to rest (m/s); with a profile, the speed at its start.
   */
  float speed;
  /*
   Largest acceleration of a motion from rest to rest (m/s²); with a profile it is not looked at.
   */
  float acceleration;
  /*
   Profile that travels the length of the path; none for a motion from rest to rest in the least time.
   */
  const struct PcrStretch *stretches;
  /*
   Number of stretches.
   */
  size_t stretch_count;
} PcrAgent;

/*
 A closed interval of times or of lengths.
 */
typedef struct PcrInterval {
  /*
   Lower end.
   */
  float lo;
  /*
   Upper end.
   */
  float hi;
} PcrInterval;

/*
 A collision region: a connected set of times and lengths that an agent has to keep out of.
 */
typedef struct PcrRegion {
  /*
   The agent that keeps out.
   */
  uint16_t ego;
  /*
   The agent that is in the way.
   */
  uint16_t other;
  /*
   Time range (s).
   */
  struct PcrInterval time;
  /*
   Length range along the path of the ego (m).
   */
  struct PcrInterval length;
  /*
   Whether it reaches back to before the other sets off, as a strip.
   */
  bool open_start;
  /*
   Whether it goes on after the other's arrival, as a strip.
   */
  bool open_end;
} PcrRegion;

/*
 A contact of two agents on their given motions.
 */
typedef struct PcrConflict {
  /*
   From when to when (s).
   */
  struct PcrInterval time;
  /*
   Lengths along the path of the ego meanwhile (m).
   */
  struct PcrInterval length;
  /*
   Lengths along the path of the other meanwhile (m).
   */
  struct PcrInterval other_length;
  /*
   Largest overlap of the discs (m).
   */
  float depth;
  /*
   Whether they do no more than touch.
   */
  bool touching;
} PcrConflict;

/*
 A conflict, and with whom.
 */
typedef struct PcrMet {
  /*
   The other agent.
   */
  size_t other;
  /*
   The conflict.
   */
  struct PcrConflict conflict;
} PcrMet;

/*
 Why there is no plan, and of whom.
 */
typedef struct PcrUnsolved {
  /*
   The reason.
   */
  enum PcrReason reason;
  /*
   The agents; twice the same where it is one.
   */
  size_t agents[2];
} PcrUnsolved;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 Makes a fleet without agents in the caller's memory.
 */
enum PcrStatus pcr_fleet_init(struct PcrFleet *place, const struct PcrMemory *memory);

/*
 Adds an agent; agents are numbered from 0. The table does not know it before `pcr_fleet_build`.
 */
enum PcrStatus pcr_fleet_add(struct PcrFleet *place, const struct PcrAgent *agent);

/*
 Number of agents; 0 for a null pointer.
 */
size_t pcr_fleet_agents(const struct PcrFleet *place);

/*
 Computes the regions of all pairs of agents. Where the table is full it is empty afterwards.
 */
enum PcrStatus pcr_fleet_build(struct PcrFleet *place);

/*
 Lets an agent set off later by `delay` (s). The table serves on as it is: lengths do not change, times follow.
 */
enum PcrStatus pcr_fleet_delay(struct PcrFleet *place,
                               size_t agent,
                               float delay);

/*
 The regions that an agent has to keep out of, by the other agent, and their count. Ranges are rounded outward.
 */
enum PcrStatus pcr_fleet_regions(const struct PcrFleet *place,
                                 size_t ego,
                                 struct PcrRegion *out,
                                 size_t capacity,
                                 size_t *count);

/*
 The lengths along the path of the ego at which it overlaps the other agent at a time, and how many intervals there
 are: those of one region after the other, rounded outward.
 */
enum PcrStatus pcr_fleet_slices(const struct PcrFleet *place,
                                size_t ego,
                                size_t other,
                                float time,
                                struct PcrInterval *out,
                                size_t capacity,
                                size_t *count);

/*
 The conflicts of two agents on their motions, in order of time from the first start of any agent to the last arrival,
 and their count. It asks the motions, not the table.
 */
enum PcrStatus pcr_fleet_conflicts(const struct PcrFleet *place,
                                   size_t ego,
                                   size_t other,
                                   struct PcrConflict *out,
                                   size_t capacity,
                                   size_t *count);

/*
 Puts another agent in the place of one, and its regions into the table if that was built. The memory needs room for the
 segments and phases of the new one beside those of the old one, which become free. Whatever fails leaves all as it was.
 */
enum PcrStatus pcr_fleet_replace(struct PcrFleet *place,
                                 size_t agent,
                                 const struct PcrAgent *by);

/*
 The earliest conflict of an agent with any other, from the first start of any agent to the last arrival, and whether
 there is one. Mere touches are passed over, unless they are asked for: plans make agents touch on purpose.
 */
enum PcrStatus pcr_fleet_first_conflict(const struct PcrFleet *place,
                                        size_t ego,
                                        bool touches,
                                        struct PcrMet *out,
                                        bool *found);

/*
 The least delay of an agent's start, from `from` on (s), with which it meets none of the others, each moving as it does
 now. `PCR_STATUS_NO_PLAN` where no delay helps. `pcr_fleet_delay` makes it so.
 */
enum PcrStatus pcr_fleet_earliest_start(const struct PcrFleet *place,
                                        size_t agent,
                                        float from,
                                        float *delay);

/*
 The times in an interval (s) at which no other agent is in the way on a part of the ego's path (m), wherever on it the ego
 is, and how many intervals there are. It asks the motions, not the table.
 */
enum PcrStatus pcr_fleet_safe_intervals(const struct PcrFleet *place,
                                        size_t ego,
                                        struct PcrInterval length,
                                        struct PcrInterval during,
                                        struct PcrInterval *out,
                                        size_t capacity,
                                        size_t *count);

/*
 Delays the starts of all agents so that none overlaps another, each as little as those before it in the order allow.
 `order` lists each agent once, the highest priority first, and comes back as it was used. `room` is for a motion an agent,
 and free afterwards. Where there is no plan, nobody is delayed and `why` tells who is in the way; it may be null.
 */
enum PcrStatus pcr_fleet_plan_delays(struct PcrFleet *place,
                                     size_t *order,
                                     size_t count,
                                     struct PcrMotion *room,
                                     size_t room_count,
                                     struct PcrUnsolved *why);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PCR_H */
