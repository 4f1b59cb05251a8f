/* The parts of the C interface of pcr that all number formats share.
   Made by cbindgen from bindings/c/src: see bindings/c/tests/header.rs. */

#ifndef PCR_COMMON_H
#define PCR_COMMON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 `PcrPathSegment.curve` of a straight line.
 */
#define PCR_LINE 0

/*
 `PcrPathSegment.curve` of an arc that turns left, counter-clockwise.
 */
#define PCR_LEFT 1

/*
 `PcrPathSegment.curve` of an arc that turns right, clockwise.
 */
#define PCR_RIGHT 2

/*
 `PcrPathSegment.curve` of a turn in place to the left.
 */
#define PCR_PIVOT_LEFT 3

/*
 `PcrPathSegment.curve` of a turn in place to the right.
 */
#define PCR_PIVOT_RIGHT 4

/*
 `PcrPathSegment.curve` of a change of gear, which has no length: the direction of travel turns by half a turn, and the
 heading of the agent stays.
 */
#define PCR_REVERSE 5

/*
 `PcrRegionPrecedence.pass` of a region that is undecided: neither agent may enter it.
 */
#define PCR_UNDECIDED 0

/*
 The agent passes the region first.
 */
#define PCR_FIRST 1

/*
 The agent waits until the other one has left the region.
 */
#define PCR_SECOND 2

/*
 One of the two agents has left the region.
 */
#define PCR_OVER 3

/*
 Result of a call. A call that fails leaves the fleet unchanged, except that a table which became full when it was
 built is empty.
 */
typedef enum PcrStatus {
  /*
   The call succeeded.
   */
  PCR_STATUS_OK = 0,
  /*
   A pointer is null.
   */
  PCR_STATUS_NULL = 1,
  /*
   A number is NaN or infinite.
   */
  PCR_STATUS_NON_FINITE = 2,
  /*
   A number is below 0 but must not be.
   */
  PCR_STATUS_NEGATIVE = 3,
  /*
   A number is not above 0 but must be.
   */
  PCR_STATUS_NON_POSITIVE = 4,
  /*
   A number is beyond the range of the format, or a path or a motion leaves it; or the lower end of an interval is
   above the upper one; or none of the lengths is on the path.
   */
  PCR_STATUS_OUT_OF_RANGE = 5,
  /*
   An arc sweeps more than one turn. Split it.
   */
  PCR_STATUS_SWEEP_OVER_ONE_TURN = 6,
  /*
   The profile is longer or shorter than the path.
   */
  PCR_STATUS_LENGTH_MISMATCH = 7,
  /*
   The curve of a leg is none of PCR_LINE, PCR_LEFT, PCR_RIGHT, PCR_PIVOT_LEFT, PCR_PIVOT_RIGHT and PCR_REVERSE.
   */
  PCR_STATUS_NO_SUCH_CURVE = 8,
  /*
   There is no agent with this number.
   */
  PCR_STATUS_NO_SUCH_AGENT = 9,
  /*
   The memory has no room for another agent, or for its segments, phases or corners.
   */
  PCR_STATUS_NO_ROOM = 10,
  /*
   The table has no room for the entries, the pieces or the orders of all regions: it needs more memory.
   */
  PCR_STATUS_TABLE_FULL = 11,
  /*
   The buffer is too small. It was filled, and the required count was written.
   */
  PCR_STATUS_BUFFER_TOO_SMALL = 12,
  /*
   The table does not belong to the agents: it was not built since the last agent was added, or an agent was
   replaced or removed after `pcr_fleet_build_row`.
   */
  PCR_STATUS_NOT_BUILT = 13,
  /*
   The order does not list every agent exactly once.
   */
  PCR_STATUS_BAD_ORDER = 14,
  /*
   There is no plan: an agent meets another one, however long it waits.
   */
  PCR_STATUS_NO_PLAN = 15,
  /*
   A number is above 0, but too small for the format.
   */
  PCR_STATUS_TOO_SMALL = 16,
  /*
   The table holds the row of another agent only (`pcr_fleet_build_row`).
   */
  PCR_STATUS_ONLY_ROW = 17,
  /*
   The agent has no region at this index of the table.
   */
  PCR_STATUS_NO_SUCH_REGION = 18,
  /*
   The fleet was given no memory for orders.
   */
  PCR_STATUS_NO_ORDERS = 19,
  /*
   The value is neither PCR_FIRST nor PCR_SECOND.
   */
  PCR_STATUS_NO_SUCH_PASS = 20,
  /*
   Orders are refused; `why` names the agent in the way.
   */
  PCR_STATUS_REFUSED = 21,
  /*
   Two agents have more than 32767 pieces with each other, or touch at more lengths of two segments than are counted,
   or the fleet has more than 65536 agents, a path more than 65535 segments or an outline more than 16 corners. More
   memory does not help.
   */
  PCR_STATUS_TOO_LARGE = 22,
  /*
   The corners of an outline are not those of a convex polygon, counter-clockwise.
   */
  PCR_STATUS_NOT_CONVEX = 23,
  /*
   The heading of an outline jumps between two legs. A turn in place needs PCR_PIVOT_LEFT or PCR_PIVOT_RIGHT.
   */
  PCR_STATUS_HEADING_JUMPS = 24,
  /*
   An arc is so tight, or the lever of a turn in place so short, that rounding a length would move the corners too far.
   */
  PCR_STATUS_LEVER = 25,
  /*
   The library was built for discs only.
   */
  PCR_STATUS_NEEDS_OUTLINES = 26,
} PcrStatus;

/*
 The list of an agent in which a fault is.
 */
typedef enum PcrInputList {
  /*
   A number of the agent itself.
   */
  PCR_INPUT_LIST_AGENT = 0,
  /*
   Its legs.
   */
  PCR_INPUT_LIST_LEGS = 1,
  /*
   Its stretches.
   */
  PCR_INPUT_LIST_STRETCHES = 2,
  /*
   Its corners.
   */
  PCR_INPUT_LIST_CORNERS = 3,
} PcrInputList;

/*
 Kind of a limit on how far an agent may go.
 */
typedef enum PcrAuthorityKind {
  /*
   The agent stands where the other agent will pass. It can only go first.
   */
  PCR_AUTHORITY_KIND_INSIDE = 0,
  /*
   The agent may go up to a length of its path, and may stand there.
   */
  PCR_AUTHORITY_KIND_AT = 1,
  /*
   The agent may go to the end of its path.
   */
  PCR_AUTHORITY_KIND_FREE = 2,
} PcrAuthorityKind;

/*
 Why there is no plan.
 */
typedef enum PcrPlanErrorKind {
  /*
   The two agents overlap at the starts of their paths.
   */
  PCR_PLAN_ERROR_KIND_STARTS = 0,
  /*
   The two agents overlap at the ends of their paths.
   */
  PCR_PLAN_ERROR_KIND_ENDS = 1,
  /*
   The two agents meet however late either of them starts.
   */
  PCR_PLAN_ERROR_KIND_ALWAYS = 2,
  /*
   The first agent cannot go because of the second, with the priorities that were tried.
   */
  PCR_PLAN_ERROR_KIND_ORDER = 3,
  /*
   The check of the plan found that the two agents overlap.
   */
  PCR_PLAN_ERROR_KIND_OVERLAP = 4,
  /*
   The times of the first agent are out of range.
   */
  PCR_PLAN_ERROR_KIND_TIMES = 5,
} PcrPlanErrorKind;

/*
 Why orders are refused.
 */
typedef enum PcrAdmissionErrorKind {
  /*
   The first agent would wait for the second for ever.
   */
  PCR_ADMISSION_ERROR_KIND_STUCK = 0,
  /*
   The first agent is where it should have waited for the second.
   */
  PCR_ADMISSION_ERROR_KIND_LATE = 1,
  /*
   The second agent is in the way of the first, whichever of them goes first.
   */
  PCR_ADMISSION_ERROR_KIND_BLOCKED = 2,
  /*
   According to their motions the two agents meet, or pass so close that it cannot be decided which one is first.
   */
  PCR_ADMISSION_ERROR_KIND_MEETING = 3,
} PcrAdmissionErrorKind;

/*
 Why an agent was refused, and which of its numbers is wrong.
 */
typedef struct PcrInputError {
  /*
   The status of the call that refused the agent; PCR_STATUS_OK if the last one succeeded.
   */
  enum PcrStatus status;
  /*
   The list in which the fault is.
   */
  enum PcrInputList list;
  /*
   Index in that list; 0 for a number of the agent itself.
   */
  size_t index;
  /*
   The number that is wrong, such as "radius"; empty if the status says all. Never null.
   */
  const char *field;
} PcrInputError;

/*
 Why there is no plan, and the agents concerned.
 */
typedef struct PcrPlanError {
  /*
   The reason.
   */
  enum PcrPlanErrorKind reason;
  /*
   The agents; twice the same number if only one is concerned.
   */
  size_t agents[2];
} PcrPlanError;

/*
 Why orders are refused, and the agents concerned.
 */
typedef struct PcrAdmissionError {
  /*
   The reason.
   */
  enum PcrAdmissionErrorKind reason;
  /*
   The agents.
   */
  size_t agents[2];
} PcrAdmissionError;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 Returns the name of a status, such as "PCR_STATUS_NO_ROOM"; "PCR_STATUS_?" for a number that is none.
 */
const char *pcr_status_name(int status);

/*
 Returns what a status means, without a full stop; "no status of pcr" for a number that is none.
 */
const char *pcr_status_text(int status);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PCR_COMMON_H */
