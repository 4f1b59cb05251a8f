// What a program of another library shares with the methods of `pcr compare`: numbers on standard input, contacts on standard
// output, and last the processor's time for the work between the two. Reading and writing do not count.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

namespace peer {

// The next number: eight bytes, in the order of this machine.
inline double number() {
  double value;
  if (std::fread(&value, sizeof value, 1, stdin) != 1) {
    std::fputs("the input ends too early\n", stderr);
    std::exit(2);
  }
  return value;
}

inline std::size_t count() { return static_cast<std::size_t>(number()); }

// Two agents, from when to when in whatever unit the method uses; no end where it tells none.
struct Contact {
  std::size_t first, second;
  double begin, end;
};

class Clock {
 public:
  Clock() : begin_(now()) {}

  // Writes the contacts, after the time since the begin.
  void report(const std::vector<Contact>& contacts) const {
    std::printf("%.9f\n", now() - begin_);
    for (const Contact& contact : contacts) {
      std::printf("%zu %zu %.17g %.17g\n", contact.first, contact.second, contact.begin, contact.end);
    }
  }

 private:
  static double now() {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double begin_;
};

}  // namespace peer
