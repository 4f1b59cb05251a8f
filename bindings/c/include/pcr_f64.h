/* Collision regions of discs on line/arc paths, in double precision: numbers up to a trillion in magnitude.
   Units: m, s, m/s, m/s^2, rad. Every function but pcr_fleet_agents returns a PcrStatus, and whatever fails changes nothing.
   Pointers are null, which is told, or point to as many values as is said. What is in a memory belongs to the fleet from
   fleet_init on, for as long as it is used; all other pointers are used during the call only. Nothing is allocated. A fleet is
   used by one thread at a time, and is not moved or copied.
   Made by cbindgen from bindings/c/src: see bindings/c/tests/header.rs. */

#ifndef PCR_F64_H
#define PCR_F64_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "pcr_common.h"

/*
 A fleet and the table of its regions.
 */
typedef struct PcrF64Fleet {
  size_t opaque[32];
} PcrF64Fleet;

/*
 Room for a segment of a path: one a leg, or one for an agent that stands.
 */
typedef struct PcrF64Segment {
  double opaque[30];
} PcrF64Segment;

/*
 Room for a phase of a profile: three an agent, or one a stretch.
 */
typedef struct PcrF64Phase {
  double opaque[7];
} PcrF64Phase;

/*
 Room for the motion of an agent.
 */
typedef struct PcrF64Motion {
  size_t pointers[4];
  double opaque[14];
} PcrF64Motion;

/*
 Room for a region in the table; each serves both agents of its pair.
 */
typedef struct PcrF64Entry {
  uint32_t opaque[2];
} PcrF64Entry;

/*
 Room for a piece of a region: what one segment of either path has to do with it.
 */
typedef struct PcrF64Piece {
  double opaque[6];
} PcrF64Piece;

/*
 Room for the order of a region.
 */
typedef struct PcrF64Order {
  double opaque[5];
} PcrF64Order;

/*
 Room for what is known of an agent, and for a check.
 */
typedef struct PcrF64Robot {
  double opaque[7];
} PcrF64Robot;

/*
 Memory for a fleet. It belongs to the fleet from `pcr_f64_fleet_init` on.
 */
typedef struct PcrF64Memory {
  /*
   For the paths.
   */
  struct PcrF64Segment *segments;
  /*
   Number of them.
   */
  size_t segment_count;
  /*
   For the profiles.
   */
  struct PcrF64Phase *phases;
  /*
   Number of them.
   */
  size_t phase_count;
  /*
   For the agents.
   */
  struct PcrF64Motion *motions;
  /*
   Number of them: the most agents.
   */
  size_t motion_count;
  /*
   For the regions.
   */
  struct PcrF64Entry *entries;
  /*
   Number of them.
   */
  size_t entry_count;
  /*
   For the pieces of the regions.
   */
  struct PcrF64Piece *pieces;
  /*
   Number of them.
   */
  size_t piece_count;
  /*
   For passing orders: as many as regions; as many more as an agent has that is admitted or replaced. Null where no orders
   are used.
   */
  struct PcrF64Order *orders;
  /*
   Number of them; 0 where no orders are used.
   */
  size_t order_count;
  /*
   For what is known of the agents, as many as `motions`; null where no orders are used.
   */
  struct PcrF64Robot *robots;
} PcrF64Memory;

/*
 A line or an arc of a path; it begins in the pose in which the one before it ends.
 */
typedef struct PcrF64Leg {
  /*
   PCR_LINE, PCR_LEFT or PCR_RIGHT.
   */
  uint8_t curve;
  /*
   Length (m), of an arc at most one turn; 0 adds nothing.
   */
  double length;
  /*
   Radius of an arc (m), above 0; of a line it is not looked at.
   */
  double radius;
} PcrF64Leg;

/*
 Motion at constant acceleration, part of a profile.
 */
typedef struct PcrF64Stretch {
  /*
   In s.
   */
  double duration;
  /*
   In m/s².
   */
  double acceleration;
} PcrF64Stretch;

/*
 A disc, its path and its motion along it.
 */
typedef struct PcrF64Agent {
  /*
   Position at the start of the path (m).
   */
  double x;
  /*
   In m.
   */
  double y;
  /*
   Direction of travel there (rad).
   */
  double heading;
  /*
   Of the disc (m), above 0.
   */
  double radius;
  /*
   When it sets off (s); it stands before, and after its arrival.
   */
  double start;
  /*
   The path; none for an agent that stands.
   */
  const struct PcrF64Leg *legs;
  /*
   Number of legs.
   */
  size_t leg_count;
  /*
   Largest speed of a motion from rest to rest (m/s); with a profile, the speed at its start.
   */
  double speed;
  /*
   Largest acceleration of a motion from rest to rest (m/s²); with a profile it is not looked at.
   */
  double acceleration;
  /*
   Profile that travels the length of the path; none for a motion from rest to rest in the least time.
   */
  const struct PcrF64Stretch *stretches;
  /*
   Number of stretches.
   */
  size_t stretch_count;
} PcrF64Agent;

/*
 A closed interval of times or of lengths.
 */
typedef struct PcrF64Interval {
  /*
   Lower end.
   */
  double lo;
  /*
   Upper end.
   */
  double hi;
} PcrF64Interval;

/*
 A collision region: a connected set of times and lengths that an agent has to keep out of.
 */
typedef struct PcrF64Region {
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
  struct PcrF64Interval time;
  /*
   Length range along the path of the ego (m).
   */
  struct PcrF64Interval length;
  /*
   Whether it reaches back to before the other sets off, as a strip.
   */
  bool open_start;
  /*
   Whether it goes on after the other's arrival, as a strip.
   */
  bool open_end;
} PcrF64Region;

/*
 A contact of two agents on their given motions.
 */
typedef struct PcrF64Conflict {
  /*
   From when to when (s).
   */
  struct PcrF64Interval time;
  /*
   Lengths along the path of the ego meanwhile (m).
   */
  struct PcrF64Interval length;
  /*
   Lengths along the path of the other meanwhile (m).
   */
  struct PcrF64Interval other_length;
  /*
   Largest overlap of the discs (m).
   */
  double depth;
  /*
   Whether they do no more than touch.
   */
  bool touching;
} PcrF64Conflict;

/*
 A conflict, and with whom.
 */
typedef struct PcrF64Met {
  /*
   The other agent.
   */
  size_t other;
  /*
   The conflict.
   */
  struct PcrF64Conflict conflict;
} PcrF64Met;

/*
 A region of an agent, and who passes it first.
 */
typedef struct PcrF64Passing {
  /*
   The place of the region in the table, for `pcr_f64_fleet_decide_at`.
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
  struct PcrF64Interval length;
  /*
   Length range along the path of the other (m).
   */
  struct PcrF64Interval other_length;
} PcrF64Passing;

/*
 What is known of where an agent is on its path.
 */
typedef struct PcrF64Progress {
  /*
   Where it is (m). The lower end may be old: it counts for what the agent has passed.
   */
  struct PcrF64Interval at;
  /*
   Where it can be at rest at the latest (m), the upper end of `at` or more. What it has promised not to go beyond
   counts, too.
   */
  double stop;
} PcrF64Progress;

/*
 How far an agent may go, and may stand there.
 */
typedef struct PcrF64Hold {
  /*
   Whether there is a limit.
   */
  PcrHoldKind kind;
  /*
   The limit (m): of PCR_HOLD_KIND_AT the length along its path, of PCR_HOLD_KIND_FREE the end of it.
   */
  double length;
} PcrF64Hold;

/*
 What a check of orders takes into account.
 */
typedef struct PcrF64Tolerances {
  /*
   So far the lower end of an agent's place may be behind it when it stands (m).
   */
  double width;
  /*
   Less way than this (m) is no progress; above 0.
   */
  double gain;
} PcrF64Tolerances;

/*
 How an agent brakes.
 */
typedef struct PcrF64Brakes {
  /*
   Deceleration (m/s²), above 0.
   */
  double deceleration;
  /*
   Reaction time (s) during which it may go on at its speed: what passes between two controls, and until one takes effect.
   */
  double reaction;
} PcrF64Brakes;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 Makes a fleet without agents in the caller's memory.
 */
PcrStatus pcr_f64_fleet_init(struct PcrF64Fleet *place, const struct PcrF64Memory *memory);

/*
 Adds an agent; agents are numbered from 0. The table does not know it before `pcr_f64_fleet_build`.
 */
PcrStatus pcr_f64_fleet_add(struct PcrF64Fleet *place, const struct PcrF64Agent *agent);

/*
 Number of agents; 0 for a null pointer.
 */
size_t pcr_f64_fleet_agents(const struct PcrF64Fleet *place);

/*
 Computes the regions of all pairs of agents; nothing is decided then about who passes them first. Where the table is
 full it is empty afterwards.
 */
PcrStatus pcr_f64_fleet_build(struct PcrF64Fleet *place);

/*
 Computes the regions of one agent with all others only: all that a robot needs that looks after itself. What is asked about
 others is refused with PCR_STATUS_ONLY_ROW.
 */
PcrStatus pcr_f64_fleet_build_row(struct PcrF64Fleet *place,
                                  size_t agent);

/*
 Lets an agent set off later by `delay` (s). The table serves on as it is: lengths do not change, times follow.
 */
PcrStatus pcr_f64_fleet_delay(struct PcrF64Fleet *place,
                              size_t agent,
                              double delay);

/*
 Puts another agent in the place of one, and its regions into the table if that was built. The memory needs room for the
 segments and phases of the new one beside those of the old one, which become free. It is at the start of its path, and
 nothing is decided about its regions; the orders that the others have with one another stay. Whatever fails leaves all as it
 was.
 */
PcrStatus pcr_f64_fleet_replace(struct PcrF64Fleet *place,
                                size_t agent,
                                const struct PcrF64Agent *by);

/*
 Removes an agent; those behind it move up by one number, with their orders. A table that was built is so afterwards.
 */
PcrStatus pcr_f64_fleet_remove(struct PcrF64Fleet *place,
                               size_t agent);

/*
 The regions that an agent has to keep out of, by the other agent, and their count. Ranges are rounded outward.
 */
PcrStatus pcr_f64_fleet_regions(const struct PcrF64Fleet *place,
                                size_t ego,
                                struct PcrF64Region *out,
                                size_t capacity,
                                size_t *count);

/*
 The lengths along the path of the ego at which it overlaps the other agent at a time, and how many intervals there
 are: those of one region after the other, rounded outward. PCR_STATUS_NO_SUCH_AGENT where both are one.
 */
PcrStatus pcr_f64_fleet_slices(const struct PcrF64Fleet *place,
                               size_t ego,
                               size_t other,
                               double time,
                               struct PcrF64Interval *out,
                               size_t capacity,
                               size_t *count);

/*
 The conflicts of two agents on their motions, in order of time from the first start of any agent to the last arrival,
 and their count. It asks the motions, not the table. PCR_STATUS_NO_SUCH_AGENT where both are one.
 */
PcrStatus pcr_f64_fleet_conflicts(const struct PcrF64Fleet *place,
                                  size_t ego,
                                  size_t other,
                                  struct PcrF64Conflict *out,
                                  size_t capacity,
                                  size_t *count);

/*
 The earliest conflict of an agent with any other, from the first start of any agent to the last arrival, and whether
 there is one. Mere touches are passed over, unless they are asked for: plans make agents touch on purpose.
 */
PcrStatus pcr_f64_fleet_first_conflict(const struct PcrF64Fleet *place,
                                       size_t ego,
                                       bool touches,
                                       struct PcrF64Met *out,
                                       bool *found);

/*
 The least delay of an agent's start, from `from` on (s), with which it meets none of the others, each moving as it does
 now. `PCR_STATUS_NO_PLAN` where no delay helps. `pcr_f64_fleet_delay` makes it so.
 */
PcrStatus pcr_f64_fleet_earliest_start(const struct PcrF64Fleet *place,
                                       size_t agent,
                                       double from,
                                       double *delay);

/*
 The times in an interval (s) at which no other agent is in the way on a part of the ego's path (m), wherever on it the ego
 is, and how many intervals there are. It asks the motions, not the table.
 */
PcrStatus pcr_f64_fleet_safe_intervals(const struct PcrF64Fleet *place,
                                       size_t ego,
                                       struct PcrF64Interval length,
                                       struct PcrF64Interval during,
                                       struct PcrF64Interval *out,
                                       size_t capacity,
                                       size_t *count);

/*
 Delays the starts of all agents so that none overlaps another, each as little as those before it in the order allow.
 `order` lists each agent once, the highest priority first, and comes back as it was used. `room` is for a motion an agent,
 and free afterwards. Where there is no plan, nobody is delayed and `why` tells who is in the way; it may be null.
 */
PcrStatus pcr_f64_fleet_plan_delays(struct PcrF64Fleet *place,
                                    size_t *order,
                                    size_t count,
                                    struct PcrF64Motion *room,
                                    size_t room_count,
                                    PcrUnsolved *why);

/*
 The regions of an agent, who passes them first, and their count.
 */
PcrStatus pcr_f64_fleet_passings(const struct PcrF64Fleet *place,
                                 size_t agent,
                                 struct PcrF64Passing *out,
                                 size_t capacity,
                                 size_t *count);

/*
 Takes the orders in which the motions of the fleet pass their regions, those of a plan without collisions. Decisions that
 were made before are overwritten. PCR_STATUS_REFUSED where two meet, or pass so near that it cannot be told who is first;
 `why` tells who, and may be null.
 */
PcrStatus pcr_f64_fleet_orders_as_planned(struct PcrF64Fleet *place,
                                          PcrRefused *why);

/*
 Decides about all regions of two agents that are not decided yet: whether the ego passes them first (PCR_FIRST) or second
 (PCR_SECOND). What is behind the second is passed. `pcr_f64_fleet_check` tells whether everybody can finish then.
 */
PcrStatus pcr_f64_fleet_decide(struct PcrF64Fleet *place,
                               size_t ego,
                               size_t other,
                               uint8_t pass);

/*
 The same for the region in one place of the table (`PcrF64Passing.place`), whether it is decided or not.
 PCR_STATUS_NO_SUCH_REGION where the agent has none there.
 */
PcrStatus pcr_f64_fleet_decide_at(struct PcrF64Fleet *place,
                                  size_t region,
                                  size_t ego,
                                  uint8_t pass);

/*
 Takes in where an agent is. Reports may come late, twice and in any order: none takes back what another one has said. It must be
 about the path that the agent has now.
 */
PcrStatus pcr_f64_fleet_report(struct PcrF64Fleet *place,
                               size_t agent,
                               const struct PcrF64Progress *report);

/*
 How far an agent may go, given what was reported of the others: it has to brake so that it stays there
 (`pcr_f64_stopping_speed`). Old reports give a hold that is too low, never one that is too high.
 */
PcrStatus pcr_f64_fleet_hold(const struct PcrF64Fleet *place,
                             size_t agent,
                             struct PcrF64Hold *out);

/*
 Whether everybody can get to the end of its path, from where all were reported, without breaking an order.
 PCR_STATUS_REFUSED where somebody would wait for ever, or is where it should have waited; `why` tells who, and may be null.
 */
PcrStatus pcr_f64_fleet_check(struct PcrF64Fleet *place,
                              const struct PcrF64Tolerances *accepted,
                              PcrRefused *why);

/*
 Gives an agent a new path, with orders for all its regions so that everybody can finish; the orders that the others have with
 one another stay as they are. `report` is where it is on the new path, which goes on along the old one up to where the agent
 can stop. `prefer` says of every agent whether the admitted one should pass it first (PCR_FIRST) or second, where both are
 possible; null for all second. The table must be built, and the memory needs room as for `pcr_f64_fleet_replace`.

 PCR_STATUS_REFUSED leaves everything as it was; `why` tells who is in the way, and may be null.
 */
PcrStatus pcr_f64_fleet_admit(struct PcrF64Fleet *place,
                              size_t agent,
                              const struct PcrF64Agent *by,
                              const struct PcrF64Progress *report,
                              const struct PcrF64Tolerances *accepted,
                              const uint8_t *prefer,
                              PcrRefused *why);

/*
 Drops the orders of regions that the first agent has left: they cost no time any more.
 */
PcrStatus pcr_f64_fleet_passed(struct PcrF64Fleet *place);

/*
 The way that is needed to stop from a speed (m/s), rounded up (m).
 */
PcrStatus pcr_f64_stopping_way(const struct PcrF64Brakes *how, double speed, double *way);

/*
 The speed from which this way (m) is enough to stop, rounded down (m/s); 0 where there is no way.
 */
PcrStatus pcr_f64_stopping_speed(const struct PcrF64Brakes *how, double way, double *speed);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PCR_F64_H */
