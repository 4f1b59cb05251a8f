// What a program of another library shares with the methods of `pcr compare`: numbers on standard input, contacts on standard
// output after the processor's time for the work between the two. Reading and writing do not count.
#pragma once

#include <algorithm>
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

inline double now() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Does the work and writes the contacts that it returns, after the time that it took. As in `pcr compare` work that is over before
// 5 ms is repeated for as long, and counts by the mean without the first time.
template <class Work>
void report(const Work& work) {
  const double brief = 0.005;
  double begin = now();
  std::vector<Contact> contacts = work();
  double time = now() - begin;
  if (time < brief) {
    const double times = std::min(std::ceil(brief / time), 10000.0);
    begin = now();
    for (double k = 0.0; k < times; ++k) contacts = work();
    time = (now() - begin) / times;
  }
  std::printf("%.9f\n", time);
  for (const Contact& contact : contacts) {
    std::printf("%zu %zu %.17g %.17g\n", contact.first, contact.second, contact.begin, contact.end);
  }
}

}  // namespace peer
