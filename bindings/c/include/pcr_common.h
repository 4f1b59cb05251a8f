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
  PCR_STATUS_NULL,
  /*
   A number is NaN or infinite.
   */
  PCR_STATUS_NON_FINITE,
  /*
   A number is below 0 but must not be.
   */
  PCR_STATUS_NEGATIVE,
  /*
   A number is not above 0 but must be.
   */
  PCR_STATUS_NON_POSITIVE,
  /*
   A number is beyond the range of the format, or a path or a motion leaves it; or the lower end of an interval is
   above the upper one; or none of the lengths is on the path.
   */
  PCR_STATUS_OUT_OF_RANGE,
  /*
   An arc sweeps more than one turn. Split it.
   */
  PCR_STATUS_SWEEP_OVER_ONE_TURN,
  /*
   The profile is longer or shorter than the path.
   */
  PCR_STATUS_LENGTH_MISMATCH,
  /*
   The curve of a leg is neither PCR_LINE, PCR_LEFT nor PCR_RIGHT.
   */
  PCR_STATUS_NO_SUCH_CURVE,
  /*
   There is no agent with this number.
   */
  PCR_STATUS_NO_SUCH_AGENT,
  /*
   The memory has no room for another agent, or for its segments or phases.
   */
  PCR_STATUS_NO_ROOM,
  /*
   The table has no room for the entries, the pieces or the orders of all regions: it needs more memory.
   */
  PCR_STATUS_TABLE_FULL,
  /*
   The buffer is too small. It was filled, and the required count was written.
   */
  PCR_STATUS_BUFFER_TOO_SMALL,
  /*
   The table does not belong to the agents: it was not built since the last agent was added, or an agent was
   replaced or removed after `pcr_fleet_build_row`.
   */
  PCR_STATUS_NOT_BUILT,
  /*
   The order does not list every agent exactly once.
   */
  PCR_STATUS_BAD_ORDER,
  /*
   There is no plan: an agent meets another one, however long it waits.
   */
  PCR_STATUS_NO_PLAN,
  /*
   A number is above 0, but too small for the format.
   */
  PCR_STATUS_TOO_SMALL,
  /*
   The table holds the row of another agent only (`pcr_fleet_build_row`).
   */
  PCR_STATUS_ONLY_ROW,
  /*
   The agent has no region at this index of the table.
   */
  PCR_STATUS_NO_SUCH_REGION,
  /*
   The fleet was given no memory for orders.
   */
  PCR_STATUS_NO_ORDERS,
  /*
   The value is neither PCR_FIRST nor PCR_SECOND.
   */
  PCR_STATUS_NO_SUCH_PASS,
  /*
   Orders are refused; `why` names the agent in the way.
   */
  PCR_STATUS_REFUSED,
  /*
   Two agents have more than 32767 pieces with each other, or the fleet has more than 65536 agents. More memory does
   not help.
   */
  PCR_STATUS_TOO_LARGE,
} PcrStatus;

/*
 Kind of a limit on how far an agent may go.
 */
typedef enum PcrAuthorityKind {
  /*
   The agent stands where the other agent will pass. It can only go first.
   */
  PCR_AUTHORITY_KIND_INSIDE,
  /*
   The agent may go up to a length of its path, and may stand there.
   */
  PCR_AUTHORITY_KIND_AT,
  /*
   The agent may go to the end of its path.
   */
  PCR_AUTHORITY_KIND_FREE,
} PcrAuthorityKind;

/*
 Why there is no plan.
 */
typedef enum PcrPlanErrorKind {
  /*
   The two agents overlap at the starts of their paths.
   */
  PCR_PLAN_ERROR_KIND_STARTS,
  /*
   The two agents overlap at the ends of their paths.
   */
  PCR_PLAN_ERROR_KIND_ENDS,
  /*
   The two agents meet however late either of them starts.
   */
  PCR_PLAN_ERROR_KIND_ALWAYS,
  /*
   The first agent cannot go because of the second, with the priorities that were tried.
   */
  PCR_PLAN_ERROR_KIND_ORDER,
  /*
   The check of the plan found that the two agents overlap.
   */
  PCR_PLAN_ERROR_KIND_OVERLAP,
  /*
   The times of the first agent are out of range.
   */
  PCR_PLAN_ERROR_KIND_TIMES,
} PcrPlanErrorKind;

/*
 Why orders are refused.
 */
typedef enum PcrAdmissionErrorKind {
  /*
   The first agent would wait for the second for ever.
   */
  PCR_ADMISSION_ERROR_KIND_STUCK,
  /*
   The first agent is where it should have waited for the second.
   */
  PCR_ADMISSION_ERROR_KIND_LATE,
  /*
   The second agent is in the way of the first, whichever of them goes first.
   */
  PCR_ADMISSION_ERROR_KIND_BLOCKED,
  /*
   According to their motions the two agents meet, or pass so close that it cannot be decided which one is first.
   */
  PCR_ADMISSION_ERROR_KIND_MEETING,
} PcrAdmissionErrorKind;

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

#endif  /* PCR_COMMON_H */
