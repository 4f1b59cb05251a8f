// C++17 wrapper of the C interface: it owns the memory, which grows as needed, and reports errors as exceptions. pcr::Fleet uses
// double, pcr::FleetF32 float, pcr::FleetQ16 fixed point in 1/65536. Indices and units are those of pcr.h.
#ifndef PCR_HPP
#define PCR_HPP

#include "pcr.h"
#include "pcr_f64.h"
#include "pcr_q16.h"
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcr {

// A call did not return PCR_STATUS_OK. what() says which call, why, and which number of an agent is wrong.
struct Error : std::runtime_error {
  Error(const char *call, PcrStatus status, const std::string &where = {})
      : std::runtime_error(std::string(call) + ": " + pcr_status_text(status) + where + " (" + pcr_status_name(status) + ")"),
        status(status) {}
  const PcrStatus status;
};

// PCR_STATUS_REFUSED, with the reason and the agents concerned.
struct Refused : Error {
  Refused(const char *call, PcrAdmissionError why)
      : Error(call, PCR_STATUS_REFUSED, ": agents " + std::to_string(why.agents[0]) + " and " + std::to_string(why.agents[1])),
        why(why) {}
  const PcrAdmissionError why;
};

// PCR_STATUS_NO_PLAN, with the reason and the agents concerned.
struct Unsolved : Error {
  Unsolved(const char *call, PcrPlanError why)
      : Error(call, PCR_STATUS_NO_PLAN, ": agents " + std::to_string(why.agents[0]) + " and " + std::to_string(why.agents[1])),
        why(why) {}
  const PcrPlanError why;
};

inline void check(const char *call, PcrStatus status) {
  if (status != PCR_STATUS_OK) throw Error(call, status);
}

// Such as ", legs[1].radius".
inline std::string where(const PcrInputError &error) {
  static const char *const lists[] = {"", "legs", "stretches", "corners"};
  const std::string list = lists[error.list], field = error.field;
  const std::string entry = list.empty() ? "" : list + "[" + std::to_string(error.index) + "]";
  if (entry.empty() && field.empty()) return "";
  return ", " + entry + (entry.empty() || field.empty() ? "" : ".") + field;
}

// Capacities with which a fleet begins. What is full is doubled.
struct Capacity {
  std::size_t agents = 16, segments = 96, phases = 64, regions = 256, pieces = 512, orders = 512, corners = 64;
};

// Gives the types and functions of a number format the names that they have in pcr.h, without prefixes.
#define PCR_FORMAT(Format, Types, functions, Number)                                                                   \
  struct Format {                                                                                                      \
    using Real = Number; using Agent = Types##Agent; using Conflict = Types##Conflict; using Handle = Types##Fleet;    \
    using Hold = Types##MovementAuthority; using Interval = Types##Interval; using Met = Types##AgentConflict;         \
    using Motion = Types##MotionStorage;                                                                               \
    using Passing = Types##RegionPrecedence; using Progress = Types##Progress; using Region = Types##Region;           \
    using Tolerances = Types##CheckTolerances;                                                                         \
    struct Storage {                                                                                                   \
      explicit Storage(const Capacity &most)                                                                           \
          : segments(most.segments), phases(most.phases), motions(most.agents), room(most.agents),                     \
            entries(most.regions), pieces(most.pieces), orders(most.orders), robots(most.agents),                      \
            corners(most.corners) {}                                                                                   \
      std::vector<Types##SegmentStorage> segments;                                                                     \
      std::vector<Types##PhaseStorage> phases;                                                                         \
      std::vector<Motion> motions, room;                                                                               \
      std::vector<Types##RegionStorage> entries;                                                                       \
      std::vector<Types##PieceStorage> pieces;                                                                         \
      std::vector<Types##PrecedenceStorage> orders;                                                                    \
      std::vector<Types##CheckStorage> robots;                                                                         \
      std::vector<Types##CornerStorage> corners;                                                                       \
      Types##Memory memory() {                                                                                         \
        return {segments.data(), segments.size(), phases.data(),  phases.size(),  motions.data(),                      \
                motions.size(),  entries.data(),  entries.size(), pieces.data(),  pieces.size(),                       \
                orders.data(),   orders.size(),   robots.data(),  corners.data(), corners.size()};                     \
      }                                                                                                                \
    };                                                                                                                 \
    using Corner = Types##Corner; using Leg = Types##PathSegment; using Stretch = Types##ProfilePhase;                 \
    static constexpr auto move = functions##move; static constexpr auto input_error = functions##input_error;          \
    static constexpr auto init = functions##init; static constexpr auto add = functions##add;                          \
    static constexpr auto agents = functions##agents; static constexpr auto build = functions##build;                  \
    static constexpr auto build_row = functions##build_row; static constexpr auto delay = functions##delay;            \
    static constexpr auto replace = functions##replace; static constexpr auto remove = functions##remove;              \
    static constexpr auto regions = functions##regions; static constexpr auto slices = functions##slices;              \
    static constexpr auto conflicts = functions##conflicts;                                                            \
    static constexpr auto forbidden_delays = functions##forbidden_delays;                                              \
    static constexpr auto first_conflict = functions##first_conflict;                                                  \
    static constexpr auto earliest_start = functions##earliest_start;                                                  \
    static constexpr auto safe_intervals = functions##safe_intervals;                                                  \
    static constexpr auto plan_delays = functions##plan_delays; static constexpr auto passings = functions##passings;  \
    static constexpr auto orders_as_planned = functions##orders_as_planned;                                            \
    static constexpr auto decide = functions##decide; static constexpr auto decide_at = functions##decide_at;          \
    static constexpr auto report = functions##report; static constexpr auto hold = functions##hold;                    \
    static constexpr auto check = functions##check; static constexpr auto admit = functions##admit;                    \
    static constexpr auto passed = functions##passed;                                                                  \
  }
PCR_FORMAT(Single, Pcr, pcr_fleet_, float);
PCR_FORMAT(Double, PcrF64, pcr_f64_fleet_, double);
PCR_FORMAT(Fixed, PcrQ16, pcr_q16_fleet_, std::int32_t);
#undef PCR_FORMAT

// A fleet with its memory. Methods throw an Error if the C function fails, or if the fleet was moved away; `size` is 0 then.
template <class F> class BasicFleet {
  struct Own {
    typename F::Handle handle;
    Capacity most;
    std::unique_ptr<typename F::Storage> storage;
  };
  std::unique_ptr<Own> own;
  typename F::Handle *at() { return own ? &own->handle : nullptr; }
  const typename F::Handle *at() const { return own ? &own->handle : nullptr; }

  // Calls until nothing is full any more: what was full is doubled, and the fleet moves there.
  template <class Call> PcrStatus growing(Call call) {
    for (;;) {
      const PcrStatus status = call();
      if (!own || (status != PCR_STATUS_NO_ROOM && status != PCR_STATUS_TABLE_FULL)) return status;
      Capacity most = own->most;
      const auto twice = [](std::size_t &room) { room = 2 * room + 1; };
      if (status == PCR_STATUS_NO_ROOM) twice(most.agents), twice(most.segments), twice(most.phases), twice(most.corners);
      else twice(most.regions), twice(most.pieces), twice(most.orders);
      auto larger = std::make_unique<typename F::Storage>(most);
      const auto memory = larger->memory();
      pcr::check("move", F::move(at(), &memory));
      own->most = most, own->storage = std::move(larger);
    }
  }
  // For calls that take an agent.
  void given(const char *call, PcrStatus status) const {
    PcrInputError error{PCR_STATUS_OK, PCR_INPUT_LIST_AGENT, 0, ""};
    if (status == PCR_STATUS_OK) return;
    if (at() && F::input_error(at(), &error) == PCR_STATUS_OK && error.status == status) throw Error(call, status, where(error));
    throw Error(call, status);
  }

  // Asks for the count first, then for all results.
  template <class T, class Ask> static std::vector<T> list(const char *call, Ask ask) {
    std::size_t count = 0;
    PcrStatus status = ask(static_cast<T *>(nullptr), std::size_t{0}, &count);
    if (status != PCR_STATUS_BUFFER_TOO_SMALL) pcr::check(call, status);
    std::vector<T> all(count);
    if (count > 0) pcr::check(call, ask(all.data(), all.size(), &count));
    return all;
  }
  static void settle(const char *call, PcrStatus status, const PcrAdmissionError &why) {
    if (status == PCR_STATUS_REFUSED) throw Refused(call, why);
    pcr::check(call, status);
  }

public:
  using Agent = typename F::Agent;
  using Corner = typename F::Corner;
  using Leg = typename F::Leg;
  using Stretch = typename F::Stretch;
  using Interval = typename F::Interval;
  using Progress = typename F::Progress;
  using Real = typename F::Real;
  using Tolerances = typename F::Tolerances;

  explicit BasicFleet(const Capacity &first = {}) : own(new Own{{}, first, std::make_unique<typename F::Storage>(first)}) {
    const auto memory = own->storage->memory();
    pcr::check("init", F::init(at(), &memory));
  }
  std::size_t add(const Agent &agent) {
    return given("add", growing([&] { return F::add(at(), &agent); })), size() - 1;
  }
  std::size_t size() const { return F::agents(at()); }
  void build() { pcr::check("build", growing([&] { return F::build(at()); })); }
  void build_row(std::size_t agent) { pcr::check("build_row", growing([&] { return F::build_row(at(), agent); })); }
  void delay(std::size_t agent, Real by) { pcr::check("delay", F::delay(at(), agent, by)); }
  void replace(std::size_t agent, const Agent &by) {
    given("replace", growing([&] { return F::replace(at(), agent, &by); }));
  }
  void remove(std::size_t agent) { pcr::check("remove", F::remove(at(), agent)); }

  std::vector<typename F::Region> regions(std::size_t ego) const {
    return list<typename F::Region>("regions", [&](auto... out) { return F::regions(at(), ego, out...); });
  }
  std::vector<Interval> slices(std::size_t ego, std::size_t other, Real time) const {
    return list<Interval>("slices", [&](auto... out) { return F::slices(at(), ego, other, time, out...); });
  }
  std::vector<typename F::Conflict> conflicts(std::size_t ego, std::size_t other) const {
    return list<typename F::Conflict>("conflicts", [&](auto... out) { return F::conflicts(at(), ego, other, out...); });
  }
  std::vector<Interval> forbidden_delays(std::size_t ego, std::size_t other, bool passing = false) const {
    auto ask = [&](auto... out) { return F::forbidden_delays(at(), ego, other, passing, out...); };
    return list<Interval>("forbidden_delays", ask);
  }
  std::vector<Interval> safe_intervals(std::size_t ego, Interval length, Interval during) const {
    auto ask = [&](auto... out) { return F::safe_intervals(at(), ego, length, during, out...); };
    return list<Interval>("safe_intervals", ask);
  }
  std::optional<typename F::Met> first_conflict(std::size_t ego, bool touches = false) const {
    typename F::Met met;
    bool found = false;
    pcr::check("first_conflict", F::first_conflict(at(), ego, touches, &met, &found));
    return found ? std::optional(met) : std::nullopt;
  }
  Real earliest_start(std::size_t agent, Real from = 0) const {
    Real found = 0;
    return pcr::check("earliest_start", F::earliest_start(at(), agent, from, &found)), found;
  }
  // Returns the order in which the agents were planned.
  std::vector<std::size_t> plan_delays(std::vector<std::size_t> order) {
    if (!own) throw Error("plan_delays", PCR_STATUS_NULL);
    PcrPlanError why{};
    const auto status = F::plan_delays(at(), order.data(), order.size(), own->storage->room.data(), own->storage->room.size(), &why);
    if (status == PCR_STATUS_NO_PLAN) throw Unsolved("plan_delays", why);
    return pcr::check("plan_delays", status), order;
  }

  std::vector<typename F::Passing> passings(std::size_t agent) const {
    return list<typename F::Passing>("passings", [&](auto... out) { return F::passings(at(), agent, out...); });
  }
  void orders_as_planned() {
    PcrAdmissionError why{};
    settle("orders_as_planned", F::orders_as_planned(at(), &why), why);
  }
  void decide(std::size_t ego, std::size_t by, std::uint8_t to) { pcr::check("decide", F::decide(at(), ego, by, to)); }
  void decide_at(std::size_t region, std::size_t ego, std::uint8_t pass) {
    pcr::check("decide_at", F::decide_at(at(), region, ego, pass));
  }
  void report(std::size_t agent, const Progress &where) { pcr::check("report", F::report(at(), agent, &where)); }
  typename F::Hold hold(std::size_t agent) const {
    typename F::Hold found;
    return pcr::check("hold", F::hold(at(), agent, &found)), found;
  }
  void check(const Tolerances &accepted) {
    PcrAdmissionError why{};
    settle("check", F::check(at(), &accepted, &why), why);
  }
  // `prefer` is empty, or has a value for every agent: PCR_FIRST or PCR_SECOND, but for `agent` itself.
  void admit(std::size_t agent, const Agent &by, const Progress &where, const Tolerances &accepted,
             const std::vector<std::uint8_t> &prefer = {}) {
    if (!prefer.empty() && prefer.size() != size()) throw Error("admit", PCR_STATUS_BAD_ORDER);
    PcrAdmissionError why{};
    const auto wanted = prefer.empty() ? nullptr : prefer.data();
    const auto status = growing([&] { return F::admit(at(), agent, &by, &where, &accepted, wanted, &why); });
    if (status == PCR_STATUS_REFUSED) throw Refused("admit", why);
    given("admit", status);
  }
  void passed() { pcr::check("passed", F::passed(at())); }
};

using Fleet = BasicFleet<Double>;
using FleetF32 = BasicFleet<Single>; using FleetQ16 = BasicFleet<Fixed>;

} // namespace pcr
#endif // PCR_HPP
