"""Start delays against a constraint solver, OR-Tools (PyPI: ortools), that knows of a fleet only what its pairs forbid.

    cargo run --release -p pcr-tests --example start_delays -- 0 0 100 2 20 | python3 tests/examples/start_delays.py [SECONDS]

For each fleet and objective: the cost of those that stay is the solver's optimum, the lower bound is not above it, and nobody could leave
out fewer. Fleets that the solver does not decide in SECONDS (10) are told. Exit status 1 if anything is wrong.
"""

import json
import math
import sys

from ortools.sat.python import cp_model

TICKS = 1 << 20  # a second
STATUS = {cp_model.OPTIMAL: "optimum", cp_model.FEASIBLE: "open", cp_model.INFEASIBLE: "impossible"}


def solved(fleet, agents, seconds, objective=None):
    """The least cost of these agents [s] and a bound of it; without an objective the fewest that are left out of all of them."""
    model = cp_model.CpModel()
    ends = [abs(end) for pair in fleet["pairs"] for interval in pair["forbidden"] for end in interval if end is not None]
    latest = int((sum(ends) + 100) * TICKS)
    delays = {agent: model.new_int_var(0, latest, "") for agent in agents}
    out = {agent: model.new_bool_var("") for agent in agents}
    for pair in fleet["pairs"]:
        i, j = pair["agents"]
        if i not in delays or j not in delays:
            continue
        for low, high in pair["forbidden"]:
            ways = [] if objective else [out[i], out[j]]
            if low is not None:
                ways.append(model.new_bool_var(""))
                model.add(delays[i] - delays[j] <= math.floor(low * TICKS)).only_enforce_if(ways[-1])
            if high is not None:
                ways.append(model.new_bool_var(""))
                model.add(delays[i] - delays[j] >= math.ceil(high * TICKS)).only_enforce_if(ways[-1])
            model.add_bool_or(ways)
    if objective == "sum_of_costs":
        model.minimize(sum(delays.values()))
    elif objective == "makespan":
        last = model.new_int_var(0, 2 * latest, "")
        for agent in agents:
            model.add(last >= delays[agent] + round(fleet["ends"][agent] * TICKS))
        model.minimize(last)
    else:
        model.minimize(sum(out.values()) * TICKS)
    solver = cp_model.CpSolver()
    solver.parameters.max_time_in_seconds = seconds
    solver.parameters.num_workers = 1
    status = STATUS.get(solver.solve(model), "unknown")
    known = status in ("optimum", "open")
    return status, *([solver.objective_value / TICKS, solver.best_objective_bound / TICKS] if known else [None, None])


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    fleets, decided, wrong = 0, 0, 0
    for line in sys.stdin:
        fleet = json.loads(line)
        fleets += 1
        everybody = range(len(fleet["ids"]))
        rounding = 1e-6 * len(everybody) + 2 * len(everybody) ** 2 / TICKS
        for plan in fleet["plans"]:
            objective = plan["objective"]
            staying = [agent for agent in everybody if fleet["ids"][agent] not in plan["left_out"]]
            base = sum(fleet["ends"][agent] for agent in staying) if objective == "sum_of_costs" else 0.0
            status, cost, bound = solved(fleet, staying, seconds, objective)
            told = f"{fleet['name']}, {objective}: {plan[objective]} s, bound {plan['lower_bound']}, proved {plan['proved']}"
            right = status == "optimum"
            if cost is not None:
                least = base + bound - rounding
                right = plan["lower_bound"] <= base + cost + rounding and plan[objective] >= least
                if status == "optimum":
                    decided += 1
                    right &= not plan["proved"] or abs(plan[objective] - base - cost) <= rounding
            if not right or status != "optimum" or not plan["proved"]:
                print(f"{'right' if right else 'WRONG'}: {told}; {status} {cost and base + cost}")
            wrong += not right
        status, fewest, _ = solved(fleet, everybody, seconds)
        if status == "optimum" and round(fewest) != len(fleet["plans"][0]["left_out"]):
            wrong += 1
            print(f"WRONG: {fleet['name']}: {len(fleet['plans'][0]['left_out'])} left out, {fewest} would do")
    print(f"{fleets} fleets, {decided} optima, {wrong} wrong")
    sys.exit(1 if wrong else 0)


main()
