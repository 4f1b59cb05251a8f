// First contacts of discs on polylines by Box2D's time of impact, line by line, with boxes around
// paths and lines in front.
//   input   number of agents; of each its radius, number of knots, and of each knot time, x, y
//   output  first contact of each pair that has one [s], without an end
//
// The solver lets shapes overlap by three slops, 15 mm, so radii are grown by that: it then stops where discs touch, to within a
// quarter of a slop. It works in single precision, so it is given places relative to the first disc.
#include <box2d/b2_distance.h>
#include <box2d/b2_time_of_impact.h>

#include <algorithm>
#include <limits>

#include "peer.h"

namespace {

struct Knot {
  double time, x, y;
};

struct Agent {
  double radius;
  std::vector<Knot> knots;
  // Left, bottom, right and top of all knots.
  double left, bottom, right, top;

  void bound() {
    left = bottom = std::numeric_limits<double>::infinity();
    right = top = -left;
    for (const Knot& knot : knots) {
      left = std::min(left, knot.x);
      right = std::max(right, knot.x);
      bottom = std::min(bottom, knot.y);
      top = std::max(top, knot.y);
    }
  }
};

Knot at(const Agent& agent, std::size_t k, double time) {
  const Knot &a = agent.knots[k], &b = agent.knots[k + 1];
  const double part = b.time > a.time ? (time - a.time) / (b.time - a.time) : 0.0;
  return {time, a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)};
}

b2Sweep sweep(const Knot& from, const Knot& to, const Knot& origin) {
  b2Sweep sweep;
  sweep.localCenter.SetZero();
  sweep.c0.Set(static_cast<float>(from.x - origin.x), static_cast<float>(from.y - origin.y));
  sweep.c.Set(static_cast<float>(to.x - origin.x), static_cast<float>(to.y - origin.y));
  sweep.a0 = sweep.a = sweep.alpha0 = 0.0f;
  return sweep;
}

bool apart(double a0, double a1, double b0, double b1, double reach) {
  return std::max(a0, a1) + reach < std::min(b0, b1) || std::max(b0, b1) + reach < std::min(a0, a1);
}

// When they first touch, infinite if they do not.
double first_contact(const Agent& a, const Agent& b) {
  const double reach = a.radius + b.radius;
  const double infinity = std::numeric_limits<double>::infinity();
  if (apart(a.left, a.right, b.left, b.right, reach) || apart(a.bottom, a.top, b.bottom, b.top, reach)) return infinity;
  const b2Vec2 centre = b2Vec2_zero;
  b2TOIInput input;
  input.proxyA.Set(&centre, 1, static_cast<float>(a.radius + 1.5 * b2_linearSlop));
  input.proxyB.Set(&centre, 1, static_cast<float>(b.radius + 1.5 * b2_linearSlop));
  input.tMax = 1.0f;
  for (std::size_t i = 0, j = 0; i + 1 < a.knots.size() && j + 1 < b.knots.size();) {
    const double from = std::max(a.knots[i].time, b.knots[j].time);
    const double to = std::min(a.knots[i + 1].time, b.knots[j + 1].time);
    const Knot a0 = at(a, i, from), a1 = at(a, i, to), b0 = at(b, j, from), b1 = at(b, j, to);
    if (!apart(a0.x, a1.x, b0.x, b1.x, reach) && !apart(a0.y, a1.y, b0.y, b1.y, reach)) {
      input.sweepA = sweep(a0, a1, a0);
      input.sweepB = sweep(b0, b1, a0);
      b2TOIOutput output;
      b2TimeOfImpact(&output, &input);
      if (output.state == b2TOIOutput::e_overlapped) return from;
      if (output.state == b2TOIOutput::e_touching) return from + static_cast<double>(output.t) * (to - from);
    }
    const bool next_a = a.knots[i + 1].time <= to, next_b = b.knots[j + 1].time <= to;
    i += next_a;
    j += next_b;
  }
  return infinity;
}

}  // namespace

int main() {
  std::vector<Agent> agents(peer::count());
  for (Agent& agent : agents) {
    agent.radius = peer::number();
    agent.knots.resize(peer::count());
    for (Knot& knot : agent.knots) {
      knot.time = peer::number();
      knot.x = peer::number();
      knot.y = peer::number();
    }
  }
  peer::report([&agents] {
    for (Agent& agent : agents) agent.bound();
    std::vector<peer::Contact> contacts;
    for (std::size_t first = 0; first < agents.size(); ++first) {
      for (std::size_t second = first + 1; second < agents.size(); ++second) {
        const double time = first_contact(agents[first], agents[second]);
        if (std::isfinite(time)) contacts.push_back({first, second, time, NAN});
      }
    }
    return contacts;
  });
}
