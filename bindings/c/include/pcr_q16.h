/* Collision regions of discs on line/arc paths, in fixed point: numbers are 1/65536 m, s, m/s and m/s^2, up to 4096 in magnitude. Headings are 1/2^32 of a turn.
   Units: m, s, m/s, m/s^2, rad. Every function but pcr_fleet_agents returns a PcrStatus, and whatever fails changes nothing.
   Pointers are null, which is told, or point to as many values as is said. What is in a memory belongs to the fleet from
   fleet_init on, for as long as it is used; all other pointers are used during the call only. Nothing is allocated. A fleet is
   used by one thread at a time, and is not moved or copied.
   Made by cbindgen from bindings/c/src: see bindings/c/tests/header.rs. */

#ifndef PCR_Q16_H
#define PCR_Q16_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "pcr_common.h"
/* Constants that a compiler evaluates: a number, and a heading in radians from -pi to pi. */
#define PCR_Q16(x) ((int32_t)((x) * 65536.0 + ((x) < 0 ? -0.5 : 0.5)))
#define PCR_Q16_RADIANS(x) ((int32_t)(uint32_t)(int64_t)((x) * 683565275.5764316 + ((x) < 0 ? -0.5 : 0.5)))

/*
 A fleet and the table of its regions.
 */
typedef struct PcrQ16Fleet {
  size_t opaque[32];
} PcrQ16Fleet;

/*
 Room for a segment of a path: one a leg, or one for an agent that stands.
 */
typedef struct PcrQ16Segment {
  int32_t opaque[30];
} PcrQ16Segment;

/*
 Room for a phase of a profile: three an agent, or one a stretch.
 */
typedef struct PcrQ16Phase {
  int32_t opaque[7];
} PcrQ16Phase;

/*
 Room for the motion of an agent.
 */
typedef struct PcrQ16Motion {
  size_t pointers[4];
  int32_t opaque[14];
} PcrQ16Motion;

/*
 Room for a region in the table; each serves both agents of its pair.
 */
typedef struct PcrQ16Entry {
  uint32_t opaque[2];
} PcrQ16Entry;

/*
 Room for a piece of a region: what one segment of either path has to do with it.
 */
typedef struct PcrQ16Piece {
  int32_t opaque[7];
} PcrQ16Piece;

/*
 Room for the order of a region.
 */
typedef struct PcrQ16Order {
  int32_t opaque[5];
} PcrQ16Order;

/*
 Room for what is known of an agent, and for a check.
 */
typedef struct PcrQ16Robot {
  int32_t opaque[7];
} PcrQ16Robot;

/*
 Memory for a fleet. It belongs to the fleet from `pcr_q16_fleet_init` on.
 */
typedef struct PcrQ16Memory {
  /*
   For the paths.
   */
  struct PcrQ16Segment *segments;
  /*
   Number of them.
   */
  size_t segment_count;
  /*
   For the profiles.
   */
  struct PcrQ16Phase *phases;
  /*
   Number of them.
   */
  size_t phase_count;
  /*
   For the agents.
   */
  struct PcrQ16Motion *motions;
  /*
   Number of them: the most agents.
   */
  size_t motion_count;
  /*
   For the regions.
   */
  struct PcrQ16Entry *entries;
  /*
   Number of them.
   */
  size_t entry_count;
  /*
   For the pieces of the regions.
   */
  struct PcrQ16Piece *pieces;
  /*
   Number of them.
   */
  size_t piece_count;
  /*
   For passing orders: as many as regions; as many more as an agent has that is admitted or replaced. Null where no orders
   are used.
   */
  struct PcrQ16Order *orders;
  /*
   Number of them; 0 where no orders are used.
   */
  size_t order_count;
  /*
   For what is known of the agents, as many as `motions`; null where no orders are used.
   */
  struct PcrQ16Robot *robots;
} PcrQ16Memory;

/*
 A line or an arc of a path; it begins in the pose in which the one before it ends.
 */
typedef struct PcrQ16Leg {
  /*
   PCR_LINE, PCR_LEFT or PCR_RIGHT.
   */
  uint8_t curve;
  /*
   Length (m), of an arc at most one turn; 0 adds nothing.
   */
  int32_t length;
  /*
   Radius of an arc (m), above 0; of a line it is not looked at.
   */
  int32_t radius;
} PcrQ16Leg;

/*
 Motion at constant acceleration, part of a profile.
 */
typedef struct PcrQ16Stretch {
  /*
   In s.
   */
  int32_t duration;
  /*
   In m/s².
   */
  int32_t acceleration;
} PcrQ16Stretch;

/*
 A disc, its path and its motion along it.
 */
typedef struct PcrQ16Agent {
  /*
   Position at the start of the path (m).
   */
  int32_t x;
  /*
   In m.
   */
  int32_t y;
  /*
   Direction of travel there (rad).
   */
  int32_t heading;
  /*
   Of the disc (m), above 0.
   */
  int32_t radius;
  /*
   When it sets off (s); it stands before, and after its arrival.
   */
  int32_t start;
  /*
   The path; none for an agent that stands.
   */
  const struct PcrQ16Leg *legs;
  /*
   Number of legs.
   */
  size_t leg_count;
  /*
   Largest speed of a motion from rest to rest (m/s); with a profile, the speed at its start.
   */
  int32_t speed;
  /*
   Largest acceleration of a motion from rest to rest (m/s²); with a profile it is not looked at.
   */
  int32_t acceleration;
  /*
   Profile that travels the length of the path; none for a motion from rest to rest in the least time.
   */
  const struct PcrQ16Stretch *stretches;
  /*
   Number of stretches.
   */
  size_t stretch_count;
} PcrQ16Agent;

/*
 A closed interval of times or of lengths.
 */
typedef struct PcrQ16Interval {
  /*
   Lower end.
   */
  int32_t lo;
  /*
   Upper end.
   */
  int32_t hi;
} PcrQ16Interval;

/*
 A collision region: a connected set of times and lengths that an agent has to keep out of.
 */
typedef struct PcrQ16Region {
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
  struct PcrQ16Interval time;
  /*
   Length range along the path of the ego (m).
   */
  struct PcrQ16Interval length;
  /*
   Whether it reaches back to before the other sets off, as a strip.
   */
  bool open_start;
  /*
   Whether it goes on after the other's arrival, as a strip.
   */
  bool open_end;
} PcrQ16Region;

/*
 A contact of two agents on their given motions.
 */
typedef struct PcrQ16Conflict {
  /*
   From when to when (s).
   */
  struct PcrQ16Interval time;
  /*
   Lengths along the path of the ego meanwhile (m).
   */
  struct PcrQ16Interval length;
  /*
   Lengths along the path of the other meanwhile (m).
   */
  struct PcrQ16Interval other_length;
  /*
   Largest overlap of the discs (m).
   */
  int32_t depth;
  /*
   Whether they do no more than touch.
   */
  bool touching;
} PcrQ16Conflict;

/*
 A conflict, and with whom.
 */
typedef struct PcrQ16Met {
  /*
   The other agent.
   */
  size_t other;
  /*
   The conflict.
   */
  struct PcrQ16Conflict conflict;
} PcrQ16Met;

/*
 A region of an agent, and who passes it first.
 */
typedef struct PcrQ16Passing {
  /*
   The place of the region in the table, for `pcr_q16_fleet_decide_at`.
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
  struct PcrQ16Interval length;
  /*
   Length range along the path of the other (m).
   */
  struct PcrQ16Interval other_length;
} PcrQ16Passing;

/*
 What is known of where an agent is on its path.
 */
typedef struct PcrQ16Progress {
  /*
   Where it is (m). The lower end may be old: it counts for what the agent has passed.
   */
  struct PcrQ16Interval at;
  /*
   Where it can be at rest at the latest (m), the upper end of `at` or more. What it has promised not to go beyond
   counts, too.
   */
  int32_t stop;
} PcrQ16Progress;

/*
 How far an agent may go, and may stand there.
 */
typedef struct PcrQ16Hold {
  /*
   Whether there is a limit.
   */
  PcrHoldKind kind;
  /*
   The limit (m): of PCR_HOLD_KIND_AT the length along its path, of PCR_HOLD_KIND_FREE the end of it.
   */
  int32_t length;
} PcrQ16Hold;

/*
 What a check of orders takes into account.
 */
typedef struct PcrQ16Tolerances {
  /*
   So far the lower end of an agent's place may be behind it when it stands (m).
   */
  int32_t width;
  /*
   Less way than this (m) is no progress; above 0.
   */
  int32_t gain;
} PcrQ16Tolerances;

/*
 How an agent brakes.
 */
typedef struct PcrQ16Brakes {
  /*
   Deceleration (m/s²), above 0.
   */
  int32_t deceleration;
  /*
   Reaction time (s) during which it may go on at its speed: what passes between two controls, and until one takes effect.
   */
  int32_t reaction;
} PcrQ16Brakes;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 Makes a fleet without agents in the caller's memory.
 */
PcrStatus pcr_q16_fleet_init(struct PcrQ16Fleet *place, const struct PcrQ16Memory *memory);

/*
 Adds an agent; agents are numbered from 0. The table does not know it before `pcr_q16_fleet_build`.
 */
PcrStatus pcr_q16_fleet_add(struct PcrQ16Fleet *place, const struct PcrQ16Agent *agent);

/*
 Number of agents; 0 for a null pointer.
 */
size_t pcr_q16_fleet_agents(const struct PcrQ16Fleet *place);

/*
 Computes the regions of all pairs of agents; nothing is decided then about who passes them first. Where the table is
 full it is empty afterwards.
 */
PcrStatus pcr_q16_fleet_build(struct PcrQ16Fleet *place);

/*
 Computes the regions of one agent with all others only: all that a robot needs that looks after itself. What is asked about
 others is refused with PCR_STATUS_ONLY_ROW.
 */
PcrStatus pcr_q16_fleet_build_row(struct PcrQ16Fleet *place,
                                  size_t agent);

/*
 Lets an agent set off later by `delay` (s). The table serves on as it is: lengths do not change, times follow.
 */
PcrStatus pcr_q16_fleet_delay(struct PcrQ16Fleet *place,
                              size_t agent,
                              int32_t delay);

/*
 Puts another agent in the place of one, and its regions into the table if that was built. The memory needs room for the
 segments and phases of the new one beside those of the old one, which become free. It is at the start of its path, and
 nothing is decided about its regions; the orders that the others have with one another stay. Whatever fails leaves all as it
 was.
 */
PcrStatus pcr_q16_fleet_replace(struct PcrQ16Fleet *place,
                                size_t agent,
                                const struct PcrQ16Agent *by);

/*
 Removes an agent; those behind it move up by one number, with their orders. A table that was built is so afterwards.
 */
PcrStatus pcr_q16_fleet_remove(struct PcrQ16Fleet *place,
                               size_t agent);

/*
 The regions that an agent has to keep out of, by the other agent, and their count. Ranges are rounded outward.
 */
PcrStatus pcr_q16_fleet_regions(const struct PcrQ16Fleet *place,
                                size_t ego,
                                struct PcrQ16Region *out,
                                size_t capacity,
                                size_t *count);

/*
 The lengths along the path of the ego at which it overlaps the other agent at a time, and how many intervals there
 are: those of one region after the other, rounded outward. PCR_STATUS_NO_SUCH_AGENT where both are one.
 */
PcrStatus pcr_q16_fleet_slices(const struct PcrQ16Fleet *place,
                               size_t ego,
                               size_t other,
                               int32_t time,
                               struct PcrQ16Interval *out,
                               size_t capacity,
                               size_t *count);

/*
 The conflicts of two agents on their motions, in order of time from the first start of any agent to the last arrival,
 and their count. It asks the motions, not the table. PCR_STATUS_NO_SUCH_AGENT where both are one.
 */
PcrStatus pcr_q16_fleet_conflicts(const struct PcrQ16Fleet *place,
                                  size_t ego,
                                  size_t other,
                                  struct PcrQ16Conflict *out,
                                  size_t capacity,
                                  size_t *count);

/*
 The earliest conflict of an agent with any other, from the first start of any agent to the last arrival, and whether
 there is one. Mere touches are passed over, unless they are asked for: plans make agents touch on purpose.
 */
PcrStatus pcr_q16_fleet_first_conflict(const struct PcrQ16Fleet *place,
                                       size_t ego,
                                       bool touches,
                                       struct PcrQ16Met *out,
                                       bool *found);

/*
 The least delay of an agent's start, from `from` on (s), with which it meets none of the others, each moving as it does
 now. `PCR_STATUS_NO_PLAN` where no delay helps. `pcr_q16_fleet_delay` makes it so.
 */
PcrStatus pcr_q16_fleet_earliest_start(const struct PcrQ16Fleet *place,
                                       size_t agent,
                                       int32_t from,
                                       int32_t *delay);

/*
 The times in an interval (s) at which no other agent is in the way on a part of the ego's path (m), wherever on it the ego
 is, and how many intervals there are. It asks the motions, not the table.
 */
PcrStatus pcr_q16_fleet_safe_intervals(const struct PcrQ16Fleet *place,
                                       size_t ego,
                                       struct PcrQ16Interval length,
                                       struct PcrQ16Interval during,
                                       struct PcrQ16Interval *out,
                                       size_t capacity,
                                       size_t *count);

/*
 Delays the starts of all agents so that none overlaps another, each as little as those before it in the order allow.
 `order` lists each agent once, the highest priority first, and comes back as it was used. `room` is for a motion an agent,
 and free afterwards. Where there is no plan, nobody is delayed and `why` tells who is in the way; it may be null.
 */
PcrStatus pcr_q16_fleet_plan_delays(struct PcrQ16Fleet *place,
                                    size_t *order,
                                    size_t count,
                                    struct PcrQ16Motion *room,
                                    size_t room_count,
                                    PcrUnsolved *why);

/*
 The regions of an agent, who passes them first, and their count.
 */
PcrStatus pcr_q16_fleet_passings(const struct PcrQ16Fleet *place,
                                 size_t agent,
                                 struct PcrQ16Passing *out,
                                 size_t capacity,
                                 size_t *count);

/*
 Takes the orders in which the motions of the fleet pass their regions, those of a plan without collisions. Decisions that
 were made before are overwritten. PCR_STATUS_REFUSED where two meet, or pass so near that it cannot be told who is first;
 `why` tells who, and may be null.
 */
PcrStatus pcr_q16_fleet_orders_as_planned(struct PcrQ16Fleet *place,
                                          PcrRefused *why);

/*
 Decides about all regions of two agents that are not decided yet: whether the ego passes them first (PCR_FIRST) or second
 (PCR_SECOND). What is behind the second is passed. `pcr_q16_fleet_check` tells whether everybody can finish then.
 */
PcrStatus pcr_q16_fleet_decide(struct PcrQ16Fleet *place,
                               size_t ego,
                               size_t other,
                               uint8_t pass);

/*
 The same for the region in one place of the table (`PcrQ16Passing.place`), whether it is decided or not.
 PCR_STATUS_NO_SUCH_REGION where the agent has none there.
 */
PcrStatus pcr_q16_fleet_decide_at(struct PcrQ16Fleet *place,
                                  size_t region,
                                  size_t ego,
                                  uint8_t pass);

/*
 Takes in where an agent is. Reports may come late, twice and in any order: none takes back what another one has said. It must be
 about the path that the agent has now.
 */
PcrStatus pcr_q16_fleet_report(struct PcrQ16Fleet *place,
                               size_t agent,
                               const struct PcrQ16Progress *report);

/*
 How far an agent may go, given what was reported of the others: it has to brake so that it stays there
 (`pcr_q16_stopping_speed`). Old reports give a hold that is too low, never one that is too high.
 */
PcrStatus pcr_q16_fleet_hold(const struct PcrQ16Fleet *place,
                             size_t agent,
                             struct PcrQ16Hold *out);

/*
 Whether everybody can get to the end of its path, from where all were reported, without breaking an order.
 PCR_STATUS_REFUSED where somebody would wait for ever, or is where it should have waited; `why` tells who, and may be null.
 */
PcrStatus pcr_q16_fleet_check(struct PcrQ16Fleet *place,
                              const struct PcrQ16Tolerances *accepted,
                              PcrRefused *why);

/*
 Gives an agent a new path, with orders for all its regions so that everybody can finish; the orders that the others have with
 one another stay as they are. `report` is where it is on the new path, which goes on along the old one up to where the agent
 can stop. `prefer` says of every agent whether the admitted one should pass it first (PCR_FIRST) or second, where both are
 possible; null for all second. The table must be built, and the memory needs room as for `pcr_q16_fleet_replace`.

 PCR_STATUS_REFUSED leaves everything as it was; `why` tells who is in the way, and may be null.
 */
PcrStatus pcr_q16_fleet_admit(struct PcrQ16Fleet *place,
                              size_t agent,
                              const struct PcrQ16Agent *by,
                              const struct PcrQ16Progress *report,
                              const struct PcrQ16Tolerances *accepted,
                              const uint8_t *prefer,
                              PcrRefused *why);

/*
 Drops the orders of regions that the first agent has left: they cost no time any more.
 */
PcrStatus pcr_q16_fleet_passed(struct PcrQ16Fleet *place);

/*
 The way that is needed to stop from a speed (m/s), rounded up (m).
 */
PcrStatus pcr_q16_stopping_way(const struct PcrQ16Brakes *how, int32_t speed, int32_t *way);

/*
 The speed from which this way (m) is enough to stop, rounded down (m/s); 0 where there is no way.
 */
PcrStatus pcr_q16_stopping_speed(const struct PcrQ16Brakes *how, int32_t way, int32_t *speed);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PCR_Q16_H */
