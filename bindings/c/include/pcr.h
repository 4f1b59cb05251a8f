/* Collision regions of discs on line/arc paths, in single precision: numbers up to a million in magnitude. Units: m, s, m/s, m/s^2, rad.
   Every function but pcr_fleet_agents returns a PcrStatus; a call that fails leaves the fleet unchanged, except that a table
   which became full when it was built is empty.
   A pointer is null, which is reported, or points to as many values as the function says. The memory given to
   fleet_init belongs to the fleet as long as the fleet is used; all other pointers are used during the call only. The library does
   not allocate. A fleet is used by one thread at a time, and is not moved or copied.
   Made by cbindgen from bindings/c/src: see bindings/c/tests/header.rs. */

#ifndef PCR_H
#define PCR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "pcr_common.h"

/*
 A fleet and the table of its regions.
 */
typedef struct PcrFleet {
  size_t opaque[40];
} PcrFleet;

/*
 Memory for a segment of a path: one for each leg, or one for an agent that stands.
 */
typedef struct PcrSegmentStorage {
  float opaque[33];
} PcrSegmentStorage;

/*
 Memory for a phase of a profile: three for each agent, or one for each stretch.
 */
typedef struct PcrPhaseStorage {
  float opaque[7];
} PcrPhaseStorage;

/*
 Memory for the motion of an agent.
 */
typedef struct PcrMotionStorage {
  size_t pointers[6];
  float opaque[18];
} PcrMotionStorage;

/*
 Memory for a region in the table; each one serves both agents of its pair.
 */
typedef struct PcrRegionStorage {
  uint32_t opaque[2];
} PcrRegionStorage;

/*
 Memory for a piece of a region: the part that belongs to one segment of each path.
 */
typedef struct PcrPieceStorage {
  float opaque[7];
} PcrPieceStorage;

/*
 Memory for the order of a region.
 */
typedef struct PcrPrecedenceStorage {
  float opaque[5];
} PcrPrecedenceStorage;

/*
 Memory for the progress of an agent, and for a check.
 */
typedef struct PcrCheckStorage {
  float opaque[7];
} PcrCheckStorage;

/*
 Memory for a corner of an outline.
 */
typedef struct PcrCornerStorage {
  float opaque[5];
} PcrCornerStorage;

/*
 Memory for a fleet. It belongs to the fleet from `pcr_fleet_init` on.
 */
typedef struct PcrMemory {
  /*
   Memory for the paths.
   */
  struct PcrSegmentStorage *segments;
  /*
   Number of segments.
   */
  size_t segment_count;
  /*
   Memory for the profiles.
   */
  struct PcrPhaseStorage *phases;
  /*
   Number of phases.
   */
  size_t phase_count;
  /*
   Memory for the agents.
   */
  struct PcrMotionStorage *motions;
  /*
   Number of motions, which limits the number of agents.
   */
  size_t motion_count;
  /*
   Memory for the regions.
   */
  struct PcrRegionStorage *entries;
  /*
   Number of entries.
   */
  size_t entry_count;
  /*
   Memory for the pieces of the regions.
   */
  struct PcrPieceStorage *pieces;
  /*
   Number of pieces.
   */
  size_t piece_count;
  /*
   Memory for passing orders: one for each region, and as many more as an agent has that is admitted or replaced.
   Null if no orders are used.
   */
  struct PcrPrecedenceStorage *orders;
  /*
   Number of orders; 0 if no orders are used.
   */
  size_t order_count;
  /*
   Memory for the progress of the agents, as many as `motions`; null if no orders are used.
   */
  struct PcrCheckStorage *robots;
  /*
   Memory for the corners of outlines; null if all agents are discs.
   */
  struct PcrCornerStorage *corners;
  /*
   Number of corners.
   */
  size_t corner_count;
} PcrMemory;

/*
 A line, an arc or a turn in place of a path. It begins where the one before it ends, in the same direction of travel.
 */
typedef struct PcrPathSegment {
  /*
   PCR_LINE, PCR_LEFT, PCR_RIGHT, PCR_PIVOT_LEFT, PCR_PIVOT_RIGHT or PCR_REVERSE.
   */
  uint8_t curve;
  /*
   Length (m); of an arc at most one turn. For a turn in place, its angle times the radius. A leg of length 0 adds
   nothing. Ignored for PCR_REVERSE.
   */
  float length;
  /*
   Radius of an arc (m), above 0. For a turn in place, the lever: the distance from the reference point at which a point
   of the agent moves at the speed of the profile. Ignored for a line and for PCR_REVERSE.
   */
  float radius;
} PcrPathSegment;

/*
 A part of a profile with constant acceleration.
 */
typedef struct PcrProfilePhase {
  /*
   Duration (s).
   */
  float duration;
  /*
   Acceleration (m/s²).
   */
  float acceleration;
} PcrProfilePhase;

/*
 A corner of an outline, in the frame of the agent: the reference point, which follows the path, is the origin.
 */
typedef struct PcrCorner {
  /*
   Distance ahead of the reference point (m).
   */
  float x;
  /*
   Distance to the left of the reference point (m).
   */
  float y;
} PcrCorner;

/*
 A disc or a convex outline, its path and its motion along the path.
 */
typedef struct PcrAgent {
  /*
   x-coordinate of the start of the path (m).
   */
  float x;
  /*
   y-coordinate of the start of the path (m).
   */
  float y;
  /*
   Direction of travel at the start (rad, or in the unit of headings that is given above).
   */
  float heading;
  /*
   Radius of the disc (m), above 0. With corners, the radius by which the polygon is rounded, 0 or more.
   */
  float radius;
  /*
   Time at which the agent sets off (s). It stands before that, and after its arrival.
   */
  float start;
  /*
   Legs of the path; none for an agent that stands.
   */
  const struct PcrPathSegment *legs;
  /*
   Number of legs.
   */
  size_t leg_count;
  /*
   Largest speed of a motion from rest to rest (m/s). With a profile, the speed at its start.
   */
  float speed;
  /*
   Largest acceleration of a motion from rest to rest (m/s²); ignored with a profile.
   */
  float acceleration;
  /*
   Profile, which must have the length of the path; none for the fastest motion from rest to rest.
   */
  const struct PcrProfilePhase *stretches;
  /*
   Number of stretches.
   */
  size_t stretch_count;
  /*
   Corners of a convex polygon, counter-clockwise, at most 16; none for a disc about the reference point. Two make a
   capsule.
   */
  const struct PcrCorner *corners;
  /*
   Number of corners.
   */
  size_t corner_count;
  /*
   Angle from the direction of travel to the heading of the outline at the start, counter-clockwise (rad, or in the unit
   of headings): 0 for an agent that looks ahead, half a turn in reverse gear. Ignored for a disc.
   */
  float facing;
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
   The agent that has to keep out of the region.
   */
  uint16_t ego;
  /*
   The agent that is in the way.
   */
  uint16_t other;
  /*
   Range of times (s).
   */
  struct PcrInterval time;
  /*
   Range of lengths along the path of the ego (m).
   */
  struct PcrInterval length;
  /*
   Whether the region begins while the other agent stands at its start; the lengths that are covered then are so at
   all earlier times.
   */
  bool open_start;
  /*
   Whether the region ends while the other agent stands at its end; the lengths that are covered then are so at all
   later times.
   */
  bool open_end;
} PcrRegion;

/*
 A contact of two agents that move by their motions.
 */
typedef struct PcrConflict {
  /*
   Interval of time (s).
   */
  struct PcrInterval time;
  /*
   Lengths along the path of the ego during the contact (m).
   */
  struct PcrInterval length;
  /*
   Lengths along the path of the other agent during the contact (m).
   */
  struct PcrInterval other_length;
  /*
   Largest overlap of the discs (m).
   */
  float depth;
  /*
   Whether it is so slight that it may be no contact; it is then no deeper than the tolerance.
   */
  bool touching;
} PcrConflict;

/*
 A conflict with another agent.
 */
typedef struct PcrAgentConflict {
  /*
   The other agent.
   */
  size_t other;
  /*
   The conflict.
   */
  struct PcrConflict conflict;
} PcrAgentConflict;

/*
 A region of an agent, and the order in which the agent passes it.
 */
typedef struct PcrRegionPrecedence {
  /*
   Index of the region in the table, for `pcr_fleet_decide_at`.
   */
  size_t place;
  /*
   The other agent.
   */
  uint16_t other;
  /*
   PCR_UNDECIDED, PCR_FIRST, PCR_SECOND or PCR_OVER, for the agent of the query.
   */
  uint8_t pass;
  /*
   Range of lengths along the path of the agent (m).
   */
  struct PcrInterval length;
  /*
   Range of lengths along the path of the other agent (m).
   */
  struct PcrInterval other_length;
} PcrRegionPrecedence;

/*
 What is known about the progress of an agent.
 */
typedef struct PcrProgress {
  /*
   Place of the agent (m). The lower end may be out of date; it decides which regions the agent has left.
   */
  struct PcrInterval at;
  /*
   The furthest length at which the agent can come to rest (m), at least the upper end of `at`. If it has promised
   not to go beyond a length, it is that length.
   */
  float stop;
} PcrProgress;

/*
 How far an agent may go; it may stand there.
 */
typedef struct PcrMovementAuthority {
  /*
   Kind of the limit.
   */
  PcrAuthorityKind kind;
  /*
   The limit (m): for PCR_AUTHORITY_KIND_AT a length along the path, for PCR_AUTHORITY_KIND_FREE the end of the path.
   */
  float length;
} PcrMovementAuthority;

/*
 Parameters of a check of orders.
 */
typedef struct PcrCheckTolerances {
  /*
   When an agent stands, the known lower end of its place may be behind it by up to this (m).
   */
  float width;
  /*
   A gain below this (m) does not count as progress; above 0.
   */
  float gain;
} PcrCheckTolerances;

/*
 How an agent brakes.
 */
typedef struct PcrBrakingModel {
  /*
   Deceleration (m/s²), above 0.
   */
  float deceleration;
  /*
   Reaction time (s) during which the agent may continue at its speed: the time between two control steps plus the
   delay until a command takes effect.
   */
  float reaction;
} PcrBrakingModel;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 Creates a fleet without agents in the memory of the caller.
 */
PcrStatus pcr_fleet_init(struct PcrFleet *place, const struct PcrMemory *memory);

/*
 Adds an agent; agents are numbered from 0. The table does not include it before `pcr_fleet_build`.
 */
PcrStatus pcr_fleet_add(struct PcrFleet *place, const struct PcrAgent *agent);

/*
 Moves a fleet, with its table and orders, into other memory, which must not overlap the memory that it has; that is free
 afterwards. A fleet that had no memory for orders, and has it now, must be built again. PCR_STATUS_NO_ROOM or
 PCR_STATUS_TABLE_FULL if it does not fit; the fleet is unchanged then.
 */
PcrStatus pcr_fleet_move(struct PcrFleet *place,
                         const struct PcrMemory *memory);

/*
 Says why the last agent was refused that was given to `pcr_fleet_add`, `pcr_fleet_replace` or `pcr_fleet_admit`.
 */
PcrStatus pcr_fleet_input_error(const struct PcrFleet *place,
                                PcrInputError *out);

/*
 Number of agents; 0 for a null pointer.
 */
size_t pcr_fleet_agents(const struct PcrFleet *place);

/*
 Computes the regions of all pairs of agents; all their orders are undecided then. If the table is too small, it is
 empty afterwards.
 */
PcrStatus pcr_fleet_build(struct PcrFleet *place);

/*
 Computes the regions of one agent with all others only, which is enough for a robot that computes its own hold.
 Queries about other agents return PCR_STATUS_ONLY_ROW.
 */
PcrStatus pcr_fleet_build_row(struct PcrFleet *place,
                              size_t agent);

/*
 Delays the start of an agent by `delay` (s). The table stays valid: its lengths do not change, and times are
 computed when queried.
 */
PcrStatus pcr_fleet_delay(struct PcrFleet *place,
                          size_t agent,
                          float delay);

/*
 Replaces an agent and, if the regions of all pairs were built, computes its regions. Those of one agent
 (`pcr_fleet_build_row`) are computed again if it is that agent and the fleet has no memory for orders; otherwise the
 table is then not built. The memory needs room for the segments and phases of the new agent in addition to those of
 the old one, which become free. The new agent is at the start of its path, and its regions are undecided; the orders
 between the other agents stay. A call that fails leaves everything unchanged.
 */
PcrStatus pcr_fleet_replace(struct PcrFleet *place,
                            size_t agent,
                            const struct PcrAgent *by);

/*
 Removes an agent; the number of every agent behind it decreases by one, orders included. If the regions of all pairs
 were built, they stay so; those of one agent (`pcr_fleet_build_row`) do not.
 */
PcrStatus pcr_fleet_remove(struct PcrFleet *place,
                           size_t agent);

/*
 The regions that an agent has to keep out of, sorted by the other agent, and their count. Ranges are rounded
 outward.
 */
PcrStatus pcr_fleet_regions(const struct PcrFleet *place,
                            size_t ego,
                            struct PcrRegion *out,
                            size_t capacity,
                            size_t *count);

/*
 The lengths along the path of the ego at which it overlaps the other agent at a time, and how many intervals there
 are: those of one region after the other, rounded outward. PCR_STATUS_NO_SUCH_AGENT where both are one.
 */
PcrStatus pcr_fleet_slices(const struct PcrFleet *place,
                           size_t ego,
                           size_t other,
                           float time,
                           struct PcrInterval *out,
                           size_t capacity,
                           size_t *count);

/*
 The conflicts of two agents on their motions, in order of time from the first start of any agent to the last arrival,
 and their count. It asks the motions, not the table. PCR_STATUS_NO_SUCH_AGENT where both are one.
 */
PcrStatus pcr_fleet_conflicts(const struct PcrFleet *place,
                              size_t ego,
                              size_t other,
                              struct PcrConflict *out,
                              size_t capacity,
                              size_t *count);

/*
 The delays of the start of the ego with which it would meet the other agent, one interval for each region of the two, rounded
 outward; negative ones are earlier starts, and the largest magnitude of the format stands for infinity. With `passing`, only
 meetings while both are under way: the unsafe intervals that solvers such as CCBS and SIPP ask for, for two edges of a
 roadmap. A fleet of the two edges is enough: `pcr_fleet_replace` puts another edge in the place of one of them.
 */
PcrStatus pcr_fleet_forbidden_delays(const struct PcrFleet *place,
                                     size_t ego,
                                     size_t other,
                                     bool passing,
                                     struct PcrInterval *out,
                                     size_t capacity,
                                     size_t *count);

/*
 The earliest conflict of an agent with any other, from the first start of any agent to the last arrival, and whether
 there is one. Mere touches are skipped unless `touches` is set, because plans make agents touch on purpose.
 */
PcrStatus pcr_fleet_first_conflict(const struct PcrFleet *place,
                                   size_t ego,
                                   bool touches,
                                   struct PcrAgentConflict *out,
                                   bool *found);

/*
 The least delay of an agent's start, from `from` on (s), with which it meets none of the others, which move as they
 do now. `PCR_STATUS_NO_PLAN` if no delay helps. Apply it with `pcr_fleet_delay`.
 */
PcrStatus pcr_fleet_earliest_start(const struct PcrFleet *place,
                                   size_t agent,
                                   float from,
                                   float *delay);

/*
 The times in an interval (s) at which no other agent blocks any of these lengths of the ego's path (m), and the
 number of intervals. It uses the motions and not the table. PCR_STATUS_OUT_OF_RANGE where none of the lengths is on
 the path; of an interval that goes beyond an end of the path, the part on it is asked for.
 */
PcrStatus pcr_fleet_safe_intervals(const struct PcrFleet *place,
                                   size_t ego,
                                   struct PcrInterval length,
                                   struct PcrInterval during,
                                   struct PcrInterval *out,
                                   size_t capacity,
                                   size_t *count);

/*
 Delays the starts of all agents so that none overlap; each delay is as small as the agents before it in the order
 allow. `order` lists each agent once, the highest priority first, and returns the order that was used. `room` needs
 one motion for each agent and can be reused afterwards. If there is no plan, no agent is delayed, `order` is the one
 that was tried last, and `why` names the agent in the way. `why` may be null.
 */
PcrStatus pcr_fleet_plan_delays(struct PcrFleet *place,
                                size_t *order,
                                size_t count,
                                struct PcrMotionStorage *room,
                                size_t room_count,
                                PcrPlanError *why);

/*
 The regions of an agent, the order in which it passes them, and their count.
 */
PcrStatus pcr_fleet_passings(const struct PcrFleet *place,
                             size_t agent,
                             struct PcrRegionPrecedence *out,
                             size_t capacity,
                             size_t *count);

/*
 Takes the orders from the motions of the fleet, which must be those of a plan without collisions. Earlier decisions
 are overwritten. PCR_STATUS_REFUSED if two agents meet, or pass so close that it cannot be decided which one is
 first; `why` then names them. `why` may be null.
 */
PcrStatus pcr_fleet_orders_as_planned(struct PcrFleet *place,
                                      PcrAdmissionError *why);

/*
 Decides the order of all undecided regions of two agents: whether the ego passes them first (PCR_FIRST) or second
 (PCR_SECOND). Parts of a region behind the second agent count as passed. `pcr_fleet_check` checks that all agents
 can still finish.
 */
PcrStatus pcr_fleet_decide(struct PcrFleet *place,
                           size_t ego,
                           size_t other,
                           uint8_t pass);

/*
 Decides the order of the region at one index of the table (`PcrRegionPrecedence.place`). An order that exists is overwritten.
 PCR_STATUS_NO_SUCH_REGION if the agent has no region there.
 */
PcrStatus pcr_fleet_decide_at(struct PcrFleet *place,
                              size_t region,
                              size_t ego,
                              uint8_t pass);

/*
 Updates the progress of an agent. Reports may come late, twice and in any order; an older report does not undo a
 newer one. The report must be about the present path of the agent; PCR_STATUS_OUT_OF_RANGE if none of its lengths is
 on it.
 */
PcrStatus pcr_fleet_report(struct PcrFleet *place,
                           size_t agent,
                           const struct PcrProgress *report);

/*
 How far an agent may go, given the reports of the others. The agent has to brake so that it does not exceed this
 (`pcr_stopping_speed`). Reports that are out of date give a hold that is too low, never one that is too high.
 */
PcrStatus pcr_fleet_hold(const struct PcrFleet *place,
                         size_t agent,
                         struct PcrMovementAuthority *out);

/*
 Checks that every agent can reach the end of its path, from the place that was reported last, without breaking an
 order. PCR_STATUS_REFUSED if an agent would wait for ever, or is where it should have waited; `why` then names it.
 `why` may be null.
 */
PcrStatus pcr_fleet_check(struct PcrFleet *place,
                          const struct PcrCheckTolerances *accepted,
                          PcrAdmissionError *why);

/*
 Gives an agent a new path and orders for all its regions, with which it can finish, and so can every agent that could
 if this one were not there. The orders between the other agents stay as they are. `report` is
 the place of the agent on the new path, which follows the old one at least up to where the agent can stop. `prefer`
 has a value for every agent: whether the admitted one should pass it first (PCR_FIRST) or second, where both are
 possible; that of the admitted one is not read. If it is null, second. The table must be built, and the memory needs
 room as for `pcr_fleet_replace`.

 The `stop` that each of the others has reported last must be as far as it can still come: at least the hold that it was told. One that
 has been told a hold since, and is beyond its report, counts as able to wait where it no longer is.

 PCR_STATUS_REFUSED leaves everything unchanged; `why` then names the agent in the way. `why` may be null.
 */
PcrStatus pcr_fleet_admit(struct PcrFleet *place,
                          size_t agent,
                          const struct PcrAgent *by,
                          const struct PcrProgress *report,
                          const struct PcrCheckTolerances *accepted,
                          const uint8_t *prefer,
                          PcrAdmissionError *why);

/*
 Drops the orders of regions that the first agent has left, so that they are not evaluated any more.
 */
PcrStatus pcr_fleet_passed(struct PcrFleet *place);

/*
 The stopping distance from a speed (m/s), rounded up (m). PCR_STATUS_OUT_OF_RANGE if it is beyond the range of the
 format.
 */
PcrStatus pcr_stopping_way(const struct PcrBrakingModel *how,
                           float speed,
                           float *way);

/*
 The largest speed from which this distance (m) is enough to stop, rounded down (m/s); 0 if the distance is not above
 0.
 */
PcrStatus pcr_stopping_speed(const struct PcrBrakingModel *how,
                             float way,
                             float *speed);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PCR_H */
