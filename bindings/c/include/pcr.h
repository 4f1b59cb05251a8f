/* Collision regions of discs on line/arc paths, in single precision: numbers up to a million in magnitude.
   Units: m, s, m/s, m/s^2, rad. Every function but pcr_fleet_agents returns a PcrStatus, and whatever fails changes nothing.
   Pointers are null, which is told, or point to as many values as is said. What is in a memory belongs to the fleet from
   fleet_init on, for as long as it is used; all other pointers are used during the call only. Nothing is allocated. A fleet is
   used by one thread at a time, and is not moved or copied.
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
  size_t opaque[32];
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
  float opaque[7];
} PcrPiece;

/*
 Room for the order of a region.
 */
typedef struct PcrOrder {
  float opaque[5];
} PcrOrder;

/*
 Room for what is known of an agent, and for a check.
 */
typedef struct PcrRobot {
  float opaque[7];
} PcrRobot;

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
  /*
   For passing orders: as many as regions; as many more as an agent has that is admitted or replaced. Null where no orders
   are used.
   */
  struct PcrOrder *orders;
  /*
   Number of them; 0 where no orders are used.
   */
  size_t order_count;
  /*
   For what is known of the agents, as many as `motions`; null where no orders are used.
   */
  struct PcrRobot *robots;
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
 A region of an agent, and who passes it first.
 */
typedef struct PcrPassing {
  /*
   The place of the region in the table, for `pcr_fleet_decide_at`.
   */
  size_t place;
  /*
   The other agent.
   */
  uint16_t other;
  /*
   PCR_UNDECIDED, PCR_FIRST, PCR_SECOND or PCR_OVER, of the agent that was asked for.
   */
  uint8_t pass;
  /*
   Length range along the path of the agent (m).
   */
  struct PcrInterval length;
  /*
   Length range along the path of the other (m).
   */
  struct PcrInterval other_length;
} PcrPassing;

/*
 What is known of where an agent is on its path.
 */
typedef struct PcrProgress {
  /*
   Where it is (m). The lower end may be old: it counts for what the agent has passed.
   */
  struct PcrInterval at;
  /*
   Where it can be at rest at the latest (m), the upper end of `at` or more. What it has promised not to go beyond
   counts, too.
   */
  float stop;
} PcrProgress;

/*
 How far an agent may go, and may stand there.
 */
typedef struct PcrHold {
  /*
   Whether there is a limit.
   */
  PcrHoldKind kind;
  /*
   The limit (m): of PCR_HOLD_KIND_AT the length along its path, of PCR_HOLD_KIND_FREE the end of it.
   */
  float length;
} PcrHold;

/*
 What a check of orders takes into account.
 */
typedef struct PcrTolerances {
  /*
   So far the lower end of an agent's place may be behind it when it stands (m).
   */
  float width;
  /*
   Less way than this (m) is no progress; above 0.
   */
  float gain;
} PcrTolerances;

/*
 How an agent brakes.
 */
typedef struct PcrBrakes {
  /*
   Deceleration (m/s²), above 0.
   */
  float deceleration;
  /*
   Reaction time (s) during which it may go on at its speed: what passes between two controls, and until one takes effect.
   */
  float reaction;
} PcrBrakes;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 Makes a fleet without agents in the caller's memory.
 */
PcrStatus pcr_fleet_init(struct PcrFleet *place, const struct PcrMemory *memory);

/*
 Adds an agent; agents are numbered from 0. The table does not know it before `pcr_fleet_build`.
 */
PcrStatus pcr_fleet_add(struct PcrFleet *place, const struct PcrAgent *agent);

/*
 Number of agents; 0 for a null pointer.
 */
size_t pcr_fleet_agents(const struct PcrFleet *place);

/*
 Computes the regions of all pairs of agents; nothing is decided then about who passes them first. Where the table is
 full it is empty afterwards.
 */
PcrStatus pcr_fleet_build(struct PcrFleet *place);

/*
 Computes the regions of one agent with all others only: all that a robot needs that looks after itself. What is asked about
 others is refused with PCR_STATUS_ONLY_ROW.
 */
PcrStatus pcr_fleet_build_row(struct PcrFleet *place,
                              size_t agent);

/*
 Lets an agent set off later by `delay` (s). The table serves on as it is: lengths do not change, times follow.
 */
PcrStatus pcr_fleet_delay(struct PcrFleet *place,
                          size_t agent,
                          float delay);

/*
 Puts another agent in the place of one, and its regions into the table if that was built. The memory needs room for the
 segments and phases of the new one beside those of the old one, which become free. It is at the start of its path, and
 nothing is decided about its regions; the orders that the others have with one another stay. Whatever fails leaves all as it
 was.
 */
PcrStatus pcr_fleet_replace(struct PcrFleet *place,
                            size_t agent,
                            const struct PcrAgent *by);

/*
 Removes an agent; those behind it move up by one number, with their orders. A table that was built is so afterwards.
 */
PcrStatus pcr_fleet_remove(struct PcrFleet *place,
                           size_t agent);

/*
 The regions that an agent has to keep out of, by the other agent, and their count. Ranges are rounded outward.
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
 The earliest conflict of an agent with any other, from the first start of any agent to the last arrival, and whether
 there is one. Mere touches are passed over, unless they are asked for: plans make agents touch on purpose.
 */
PcrStatus pcr_fleet_first_conflict(const struct PcrFleet *place,
                                   size_t ego,
                                   bool touches,
                                   struct PcrMet *out,
                                   bool *found);

/*
 The least delay of an agent's start, from `from` on (s), with which it meets none of the others, each moving as it does
 now. `PCR_STATUS_NO_PLAN` where no delay helps. `pcr_fleet_delay` makes it so.
 */
PcrStatus pcr_fleet_earliest_start(const struct PcrFleet *place,
                                   size_t agent,
                                   float from,
                                   float *delay);

/*
 The times in an interval (s) at which no other agent is in the way on a part of the ego's path (m), wherever on it the ego
 is, and how many intervals there are. It asks the motions, not the table.
 */
PcrStatus pcr_fleet_safe_intervals(const struct PcrFleet *place,
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
PcrStatus pcr_fleet_plan_delays(struct PcrFleet *place,
                                size_t *order,
                                size_t count,
                                struct PcrMotion *room,
                                size_t room_count,
                                PcrUnsolved *why);

/*
 The regions of an agent, who passes them first, and their count.
 */
PcrStatus pcr_fleet_passings(const struct PcrFleet *place,
                             size_t agent,
                             struct PcrPassing *out,
                             size_t capacity,
                             size_t *count);

/*
 Takes the orders in which the motions of the fleet pass their regions, those of a plan without collisions. Decisions that
 were made before are overwritten. PCR_STATUS_REFUSED where two meet, or pass so near that it cannot be told who is first;
 `why` tells who, and may be null.
 */
PcrStatus pcr_fleet_orders_as_planned(struct PcrFleet *place,
                                      PcrRefused *why);

/*
 Decides about all regions of two agents that are not decided yet: whether the ego passes them first (PCR_FIRST) or second
 (PCR_SECOND). What is behind the second is passed. `pcr_fleet_check` tells whether everybody can finish then.
 */
PcrStatus pcr_fleet_decide(struct PcrFleet *place,
                           size_t ego,
                           size_t other,
                           uint8_t pass);

/*
 The same for the region in one place of the table (`PcrPassing.place`), whether it is decided or not.
 PCR_STATUS_NO_SUCH_REGION where the agent has none there.
 */
PcrStatus pcr_fleet_decide_at(struct PcrFleet *place,
                              size_t region,
                              size_t ego,
                              uint8_t pass);

/*
 Takes in where an agent is. Reports may come late, twice and in any order: none takes back what another one has said. It must be
 about the path that the agent has now.
 */
PcrStatus pcr_fleet_report(struct PcrFleet *place,
                           size_t agent,
                           const struct PcrProgress *report);

/*
 How far an agent may go, given what was reported of the others: it has to brake so that it stays there
 (`pcr_stopping_speed`). Old reports give a hold that is too low, never one that is too high.
 */
PcrStatus pcr_fleet_hold(const struct PcrFleet *place,
                         size_t agent,
                         struct PcrHold *out);

/*
 Whether everybody can get to the end of its path, from where all were reported, without breaking an order.
 PCR_STATUS_REFUSED where somebody would wait for ever, or is where it should have waited; `why` tells who, and may be null.
 */
PcrStatus pcr_fleet_check(struct PcrFleet *place,
                          const struct PcrTolerances *accepted,
                          PcrRefused *why);

/*
 Gives an agent a new path, with orders for all its regions so that everybody can finish; the orders that the others have with
 one another stay as they are. `report` is where it is on the new path, which goes on along the old one up to where the agent
 can stop. `prefer` says of every agent whether the admitted one should pass it first (PCR_FIRST) or second, where both are
 possible; null for all second. The table must be built, and the memory needs room as for `pcr_fleet_replace`.

 PCR_STATUS_REFUSED leaves everything as it was; `why` tells who is in the way, and may be null.
 */
PcrStatus pcr_fleet_admit(struct PcrFleet *place,
                          size_t agent,
                          const struct PcrAgent *by,
                          const struct PcrProgress *report,
                          const struct PcrTolerances *accepted,
                          const uint8_t *prefer,
                          PcrRefused *why);

/*
 Drops the orders of regions that the first agent has left: they cost no time any more.
 */
PcrStatus pcr_fleet_passed(struct PcrFleet *place);

/*
 The way that is needed to stop from a speed (m/s), rounded up (m).
 */
PcrStatus pcr_stopping_way(const struct PcrBrakes *how, float speed, float *way);

/*
 The speed from which this way (m) is enough to stop, rounded down (m/s); 0 where there is no way.
 */
PcrStatus pcr_stopping_speed(const struct PcrBrakes *how, float way, float *speed);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PCR_H */
