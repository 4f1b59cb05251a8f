// Unsafe delays of pairs of straight edges by the conic of Walker and Sturtevant (arXiv 1908.09707), cut by the ends of the edges as
// the program of CPLP does it, with the sign of its case of equal velocities mended: docs/theory/equations.md, "As others compute them".
//
// Reads `x y u v` an edge, then takes every pair so often as is said: delays ROUNDS REACH < edges. Prints nanoseconds a pair, how
// many pairs have an interval, and the sum of the ends.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

struct Edge {
    double x, y, u, v;
};

struct Interval {
    double lo = INFINITY, hi = -INFINITY;
    void add(double delay) {
        lo = std::min(lo, delay);
        hi = std::max(hi, delay);
    }
};

// Both roots of x² + p x + q to what takes them.
template <typename Take> static void roots(double p, double q, Take take) {
    const double under = p * p / 4 - q;
    if (under < 0) return;
    const double root = std::sqrt(under);
    take(-p / 2 - root);
    take(-p / 2 + root);
}

static Interval delays(const Edge &a, const Edge &b, double reach) {
    double vax = a.u - a.x, vay = a.v - a.y, vbx = b.u - b.x, vby = b.v - b.y;
    const double da = std::sqrt(vax * vax + vay * vay), db = std::sqrt(vbx * vbx + vby * vby);
    vax /= da, vay /= da, vbx /= db, vby /= db;
    const double gx = vax - vbx, gy = vay - vby, wx = a.x - b.x, wy = a.y - b.y;
    const double A = gx * gx + gy * gy, B = 2 * (vbx * gx + vby * gy), C = vbx * vbx + vby * vby;
    const double D = 2 * (wx * gx + wy * gy), E = 2 * (vbx * wx + vby * wy), F = wx * wx + wy * wy - reach * reach;
    Interval found;
    if (std::sqrt(A) < 1e-6) {
        Interval all;
        roots(E / C, F / C, [&](double delay) { all.add(delay); });
        if (all.lo <= da && -db <= all.hi) {
            found.add(std::max(all.lo, -db));
            found.add(std::min(all.hi, da));
        }
        return found;
    }
    roots(E / C, F / C, [&](double delay) { if (-db <= delay && delay <= 0) found.add(delay); });
    roots((B * da + E) / C, (A * da * da + D * da + F) / C,
          [&](double delay) { if (da - db <= delay && delay <= da) found.add(delay); });
    const double all = A + B + C;
    roots((D + E) / all, F / all, [&](double delay) { if (0 <= delay && delay <= da) found.add(delay); });
    roots((2 * A * db + B * db + D + E) / all, (A * db * db + D * db + F) / all,
          [&](double delay) { if (0 <= delay + db && delay + db <= da) found.add(delay); });
    const double bent = 4 * A * C - B * B;
    if (bent > 0) {
        const double centre = (B * D - 2 * A * E) / bent, g = 2 * B * D - 4 * A * E;
        const double half = std::sqrt(g * g + 4 * bent * (D * D - 4 * A * F)) / (2 * bent);
        for (const double delay : {centre - half, centre + half}) {
            const double time = (-B * delay - D) / (2 * A);
            if (0 <= time && time <= da && time - db <= delay && delay <= time) found.add(delay);
        }
    }
    const double corners[4][2] = {{0, 0}, {da, da}, {da, da - db}, {0, -db}};
    for (const auto &corner : corners) {
        const double t = corner[0], delay = corner[1];
        if (A * t * t + B * t * delay + C * delay * delay + D * t + E * delay + F <= 0) found.add(delay);
    }
    return found;
}

int main(int count, char **arguments) {
    if (count != 3) return 2;
    const int rounds = std::atoi(arguments[1]);
    const double reach = std::atof(arguments[2]);
    std::vector<Edge> edges;
    Edge edge;
    while (std::scanf("%lf %lf %lf %lf", &edge.x, &edge.y, &edge.u, &edge.v) == 4) edges.push_back(edge);
    double least = INFINITY, sum = 0;
    size_t met = 0;
    for (int round = 0; round < rounds; ++round) {
        sum = 0, met = 0;
        const auto start = std::chrono::steady_clock::now();
        for (size_t i = 0; i < edges.size(); ++i) {
            for (size_t j = i; j < edges.size(); ++j) {
                const Interval found = delays(edges[i], edges[j], reach);
                if (found.lo <= found.hi) {
                    ++met;
                    sum += found.hi - found.lo;
                }
            }
        }
        const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
        least = std::min(least, took.count() / (0.5 * edges.size() * (edges.size() + 1)));
    }
    std::printf("%.1f %zu %.9f\n", least, met, sum);
}
