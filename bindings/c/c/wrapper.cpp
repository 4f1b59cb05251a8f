// The C++ wrapper in all three number formats: what it computes, what it throws, and that it can be moved.
#include "pcr.hpp"
#include <cmath>
#include <cstdio>
#include <type_traits>
#include <utility>

static int failures = 0;
#define EXPECT(what) \
  if (!(what)) std::printf("line %d: %s\n", __LINE__, #what), failures++

// West to east, south to north, and one that stands aside; `real` makes a number of the format, `back` a double of it.
template <class F, class Make, class Back>
void crossing(const char *name, Make real, Back back, typename F::Agent quarter) {
  using Fleet = pcr::BasicFleet<F>;
  const auto one = real(1.0);
  auto agent = [&](double x, double y, decltype(quarter.heading) turned, decltype(quarter.legs) legs, std::size_t count) {
    typename F::Agent agent{};
    agent.x = real(x), agent.y = real(y), agent.heading = turned, agent.radius = real(0.25);
    agent.legs = legs, agent.leg_count = count, agent.speed = one, agent.acceleration = one;
    return agent;
  };
  static const std::remove_const_t<std::remove_pointer_t<decltype(quarter.legs)>> line[] = {{PCR_LINE, real(4.0), real(0.0)}};
  const auto east = agent(-2.0, 0.0, 0, line, 1);
  const auto north = agent(0.0, -2.0, quarter.heading, line, 1);
  const auto stands = agent(1.0, 2.0, 0, nullptr, 0);
  Fleet first;
  EXPECT(first.add(east) == 0 && first.add(north) == 1 && first.add(stands) == 2);
  try {
    first.regions(0);
    EXPECT(!"a table that was not built");
  } catch (const pcr::Error &error) { EXPECT(error.status == PCR_STATUS_NOT_BUILT); }
  first.build();
  Fleet fleet = std::move(first);
  EXPECT(first.size() == 0);
  const auto refused = [](auto call) {
    try { call(); } catch (const pcr::Error &error) { return error.status == PCR_STATUS_NULL; }
    return false;
  };
  EXPECT(refused([&] { first.build(); }) && refused([&] { first.regions(0); }) && refused([&] { first.plan_delays({}); }));
  const auto regions = fleet.regions(0);
  EXPECT(regions.size() == 1 && std::abs(back(regions[0].length.lo) - 1.5) < 1e-3);
  EXPECT(fleet.conflicts(0, 1).size() == 1 && fleet.first_conflict(1) && !fleet.first_conflict(2));
  EXPECT(fleet.slices(0, 1, real(2.5)).size() == 1);
  EXPECT(fleet.forbidden_delays(0, 1).size() == 1 && fleet.forbidden_delays(0, 1, true).size() == 1);
  EXPECT(fleet.safe_intervals(0, {real(2.0), real(2.0)}, {real(0.0), real(9.0)}).size() == 2);
  try {
    fleet.safe_intervals(0, {real(5.0), real(6.0)}, {real(0.0), real(9.0)});
    EXPECT(!"it is not on the path");
  } catch (const pcr::Error &error) { EXPECT(error.status == PCR_STATUS_OUT_OF_RANGE); }
  try {
    fleet.orders_as_planned();
    EXPECT(!"two that meet are no plan");
  } catch (const pcr::Refused &refused) { EXPECT(refused.why.reason == PCR_ADMISSION_ERROR_KIND_MEETING && refused.why.agents[1] == 1); }
  EXPECT(std::abs(back(fleet.earliest_start(1)) - std::sqrt(0.5)) < 1e-2);
  EXPECT(fleet.plan_delays({1, 0, 2}).size() == 3);
  fleet.delay(0, real(1.0)); // well apart: a plan lets them touch
  fleet.orders_as_planned();
  fleet.check({real(0.01), real(0.001)});
  const auto passings = fleet.passings(0);
  EXPECT(passings.size() == 1 && passings[0].pass == PCR_SECOND && passings[0].other == 1);
  EXPECT(fleet.hold(0).kind == PCR_AUTHORITY_KIND_AT && fleet.hold(1).kind == PCR_AUTHORITY_KIND_FREE);
  fleet.report(1, {{real(2.75), real(2.75)}, real(2.75)});
  EXPECT(fleet.hold(0).kind == PCR_AUTHORITY_KIND_FREE);
  fleet.passed();
  fleet.decide_at(passings[0].place, 0, PCR_FIRST);
  // One that would stand on the path of the first for good.
  try {
    fleet.admit(2, agent(0.5, 0.0, 0, nullptr, 0), {}, {real(0.01), real(0.001)});
    EXPECT(!"it is in the way");
  } catch (const pcr::Refused &refused) { EXPECT(refused.why.reason == PCR_ADMISSION_ERROR_KIND_BLOCKED); }
  fleet.replace(2, agent(1.0, -2.0, quarter.heading, line, 1));
  fleet.decide(2, 0, PCR_SECOND);
  fleet.remove(1);
  EXPECT(fleet.size() == 2 && fleet.passings(1).size() == 1 && fleet.passings(1)[0].pass == PCR_SECOND);
  fleet.build_row(1);
  EXPECT(fleet.regions(1).size() == 1);
  // What is full is doubled: agents, regions and orders of 40 robots that all meet.
  pcr::Capacity small{1, 1, 3, 1, 1, 1, 0};
  Fleet full(small);
  for (std::size_t k = 0; k < 40; k++) EXPECT(full.add(k % 2 ? north : east) == k);
  full.build();
  EXPECT(full.size() == 40 && full.regions(0).size() >= 39 && full.passings(1).size() >= 39);
  auto wrong = north;
  wrong.legs = nullptr;
  try {
    full.add(wrong);
    EXPECT(!"it has no legs");
  } catch (const pcr::Error &error) { EXPECT(error.status == PCR_STATUS_NULL && full.size() == 40); }
  const std::decay_t<decltype(line[0])> bent[] = {line[0], {PCR_LEFT, real(1.0), real(-1.0)}};
  try {
    full.replace(0, agent(0.0, 0.0, 0, bent, 2));
    EXPECT(!"a radius below 0");
  } catch (const pcr::Error &error) { EXPECT(std::string(error.what()).find("legs[1].radius") != std::string::npos); }
  // Two trucks, 1.2 m long and 0.8 m wide, in lanes that are 0.81 m apart, and 0.79 m.
  const typename Fleet::Corner truck[] = {{real(-0.6), real(-0.4)}, {real(0.6), real(-0.4)}, {real(0.6), real(0.4)}, {real(-0.6), real(0.4)}};
  for (const double apart : {0.81, 0.79}) {
    Fleet lanes(pcr::Capacity{0, 0, 0, 0, 0, 0, 0});
    for (const double y : {0.0, apart}) {
      auto one_way = agent(-2.0, y, 0, line, 1);
      one_way.radius = real(0.0), one_way.corners = truck, one_way.corner_count = 4;
      one_way.start = real(y);
      lanes.add(one_way);
    }
    lanes.build();
    EXPECT(lanes.regions(0).size() == (apart > 0.8 ? 0 : 1));
  }
  try {
    fleet.conflicts(1, 1);
    EXPECT(!"nobody is in conflict with itself");
  } catch (const pcr::Error &error) { EXPECT(error.status == PCR_STATUS_NO_SUCH_AGENT); }
  // Vectors without elements have null pointers.
  Fleet empty(pcr::Capacity{0, 0, 0, 0, 0, 0, 0});
  EXPECT(empty.size() == 0);
  empty.build();
  EXPECT(empty.add(east) == 0);
  std::printf("%s: %s\n", name, failures == 0 ? "passed" : "failed");
}

int main() {
  PcrAgent single{};
  PcrF64Agent twice{};
  PcrQ16Agent fixed{};
  single.heading = 1.5707963f, twice.heading = 1.5707963267948966, fixed.heading = PCR_Q16_RADIANS(1.5707963267948966);
  crossing<pcr::Single>("float", [](double x) { return static_cast<float>(x); }, [](float x) { return double(x); }, single);
  crossing<pcr::Double>("double", [](double x) { return x; }, [](double x) { return x; }, twice);
  crossing<pcr::Fixed>("Q16.16", [](double x) { return PCR_Q16(x); }, [](std::int32_t x) { return x / 65536.0; }, fixed);
  return failures == 0 ? 0 : 1;
}
