/* What the interface of pcr has in all number formats.
   Made by cbindgen from bindings/c/src: see bindings/c/tests/header.rs. */

#ifndef PCR_COMMON_H
#define PCR_COMMON_H

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
 `PcrPassing.pass` of a region that nothing is decided about: neither agent may enter it.
 */
#define PCR_UNDECIDED 0

/*
 The agent passes the region first.
 */
#define PCR_FIRST 1

/*
 The agent waits until the other one is through.
 */
#define PCR_SECOND 2

/*
 One of the two has left the region behind.
 */
#define PCR_OVER 3

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
   A number is beyond the range of the format, or a path or a motion gets there; the lower end of an interval is above the
   upper one.
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
   The table has no room for the entries, the pieces or the orders of all regions.
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
  /*
   A number is above 0, but less than the format can work with.
   */
  PCR_STATUS_TOO_SMALL,
  /*
   The table is that of the row of another agent only (`pcr_fleet_build_row`).
   */
  PCR_STATUS_ONLY_ROW,
  /*
   There is no region of the agent in that place of the table.
   */
  PCR_STATUS_NO_SUCH_REGION,
  /*
   The fleet was given no memory for orders.
   */
  PCR_STATUS_NO_ORDERS,
  /*
   It is neither PCR_FIRST nor PCR_SECOND.
   */
  PCR_STATUS_NO_SUCH_PASS,
  /*
   Orders are refused; `why` tells who is in the way.
   */
  PCR_STATUS_REFUSED,
} PcrStatus;

/*
 How far an agent may go.
 */
typedef enum PcrHoldKind {
  /*
   Nowhere: where it is the other one will pass. It can only be first.
   */
  PCR_HOLD_KIND_INSIDE,
  /*
   Up to a length of its path, where it may stand.
   */
  PCR_HOLD_KIND_AT,
  /*
   To the end of its path.
   */
  PCR_HOLD_KIND_FREE,
} PcrHoldKind;

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
 Why orders are refused.
 */
typedef enum PcrRefusal {
  /*
   The first agent would wait for the second for ever.
   */
  PCR_REFUSAL_STUCK,
  /*
   The first agent is where it should have waited for the second.
   */
  PCR_REFUSAL_LATE,
  /*
   The second agent is in the way of the first, whoever of them goes first.
   */
  PCR_REFUSAL_BLOCKED,
  /*
   By their motions the two meet, or pass so near that it cannot be told who is first.
   */
  PCR_REFUSAL_MEETING,
} PcrRefusal;

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

/*
 Why orders are refused, and who is in the way.
 */
typedef struct PcrRefused {
  /*
   The reason.
   */
  enum PcrRefusal reason;
  /*
   The agents.
   */
  size_t agents[2];
} PcrRefused;

#endif  /* PCR_COMMON_H */
