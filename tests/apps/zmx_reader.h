// SPDX-License-Identifier: Apache-2.0
// A small reader of sequential Zemax files that traces what it has read: surfaces by their sag
// alone, gradients by differences, nothing of optics/.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace lorgnette::zmx {

using Vec = Eigen::Matrix<long double, 3, 1>;
using Mat = Eigen::Matrix<long double, 3, 3>;

struct Surface {
  std::string type;
  long double curvature = 0, conic = 0, distance = 0;
  std::map<int, long double> parameters;
  std::optional<long double> index;  // of the glass behind it
  bool stop = false;

  long double Parameter(int i) const {
    const auto found = parameters.find(i);
    return found == parameters.end() ? 0 : found->second;
  }
  // Height of a circle or conic of this curvature at r.
  static long double Arc(long double c, long double k, long double r2) {
    return c * r2 / (1 + std::sqrt(1 - (1 + k) * c * c * r2));
  }
  long double Sag(long double x, long double y) const {
    if (type == "STANDARD") return Arc(curvature, conic, x * x + y * y);
    if (type == "EVENASPH") {
      const long double r2 = x * x + y * y;
      long double sum = Arc(curvature, conic, r2), power = 1;
      for (int i = 1; i <= 8; ++i) sum += Parameter(i) * (power *= r2);
      return sum;
    }
    // TOROIDAL: a curve in the y-z plane turned about an axis parallel to y, PARM 1 away.
    const long double g = Arc(curvature, conic, y * y), radius = Parameter(1);
    if (radius == 0) return g;
    const long double rest = radius - g;
    return radius - std::copysign(std::sqrt(rest * rest - x * x), radius);
  }
};

struct System {
  std::vector<Surface> surfaces;

  static System Read(const std::string& text) {
    System system;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string key, a, b;
      words >> key >> a >> b;
      if (key == "SURF") system.surfaces.emplace_back();
      if (system.surfaces.empty()) continue;
      Surface& s = system.surfaces.back();
      if (key == "TYPE") s.type = a;
      if (key == "CURV") s.curvature = std::stold(a);
      if (key == "CONI") s.conic = std::stold(a);
      if (key == "DISZ") s.distance = a == "INFINITY" ? 0 : std::stold(a);
      if (key == "PARM") s.parameters[std::stoi(a)] = std::stold(b);
      if (key == "STOP") s.stop = true;
      if (key == "GLAS") {
        std::string skipped, index;
        words >> skipped >> index;
        s.index = std::stold(index);
      }
    }
    return system;
  }

  struct Ray {
    Vec p, d;
  };
  // From the first surface after the object (its axes) to the stop; the ray in the stop's axes.
  Ray TraceToStop(Ray ray) const {
    long double before = 1;
    for (std::size_t i = 1; i < surfaces.size(); ++i) {
      const Surface& s = surfaces[i];
      if (s.type == "COORDBRK") {
        const auto turn = [&](int parameter, const Vec& axis) {
          return Eigen::AngleAxis<long double>(
                     s.Parameter(parameter) * 3.14159265358979323846L / 180, axis)
              .toRotationMatrix();
        };
        // Right-handed tilts about x, then the new y, then the new z.
        const Mat axes = turn(3, Vec::UnitX()) * turn(4, Vec::UnitY()) * turn(5, Vec::UnitZ());
        ray = {axes.transpose() * ray.p, axes.transpose() * ray.d};
      } else {
        Meet(s, ray);
        if (s.stop) return ray;
        const long double after = s.index.value_or(1);
        Bend(s, before / after, ray);
        before = after;
      }
      ray.p.z() -= s.distance;
    }
    return ray;
  }

 private:
  static Vec Normal(const Surface& s, long double x, long double y) {
    constexpr long double h = 1e-4L;  // central differences of fourth order: 1e-16 or so
    const auto slope = [&](const auto& f) {
      return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
    };
    const long double zx = slope([&](long double e) { return s.Sag(x + e, y); });
    const long double zy = slope([&](long double e) { return s.Sag(x, y + e); });
    return Vec(-zx, -zy, 1).normalized();
  }
  static void Meet(const Surface& s, Ray& ray) {
    ray.p -= ray.p.z() / ray.d.z() * ray.d;
    for (int i = 0; i < 60; ++i) {
      const Vec n = Normal(s, ray.p.x(), ray.p.y());
      const long double miss = ray.p.z() - s.Sag(ray.p.x(), ray.p.y());
      ray.p -= miss * n.z() / n.dot(ray.d) * ray.d;
      if (std::abs(miss) < 1e-17L) return;
    }
  }
  static void Bend(const Surface& s, long double eta, Ray& ray) {
    const Vec n = Normal(s, ray.p.x(), ray.p.y());
    const long double c = n.dot(ray.d);
    const long double after = std::sqrt(1 - eta * eta * (1 - c * c));
    ray.d = (eta * ray.d + (after - eta * c) * n).normalized();
  }
};

}  // namespace lorgnette::zmx
