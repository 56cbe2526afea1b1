// SPDX-License-Identifier: Apache-2.0
// Shadow of the frame on the face: the ratio of equation (2) at points of the skin, by rays at
// every point, by visibility baked once, and by spherical harmonics.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/units.h"
#include "render/directions.h"
#include "render/embree_scene.h"
#include "render/lighting.h"
#include "validation/cost/scene.h"
#include "validation/cost/stopwatch.h"
#include "validation/cost/studies.h"

namespace lorgnette::validation {
namespace {

constexpr float kLift_mm = 0.02f;  // as the compositor's rays against the frame
constexpr int kReferenceRays = 16384;
constexpr std::size_t kMostPoints = 600;
constexpr std::uint32_t kRotations = 64;  // of one set, by point

// A point of the skin that a pixel sees, close enough to the frame to be shaded.
struct SkinPoint {
  SurfacePoint at;
  std::uint32_t triangle;
  float u, v;
};

struct ShadingScene {
  EmbreeScene rays;
  TriangleMesh frame;  // head space
  Eigen::Matrix3f world_from_head;
  std::vector<SkinPoint> points;
  long shaded_pixels = 0;  // of the picture
};

// Sum of light with and without the frame; their ratio is the shadow.
struct Light {
  Eigen::Vector3f with{0, 0, 0}, without{0, 0, 0};
  Eigen::Vector3f Ratio() const {
    Eigen::Vector3f ratio;
    for (int c = 0; c < 3; ++c) ratio[c] = without[c] > 0 ? with[c] / without[c] : 1.0f;
    return ratio;
  }
};

// Directions about +z with weights: sum of weight * radiance is the light.
struct DirectionSet {
  std::vector<Eigen::Vector3f> directions;
  std::vector<float> weights;  // empty: all equal
};

TriangleMesh FrameInHead(const Eyewear& eyewear) {
  TriangleMesh mesh;
  for (const FramePart& part : eyewear.frame.parts) {
    if (part.kind == FramePartKind::kDemoLens) continue;
    TriangleMesh piece = part.mesh;
    for (Eigen::Vector3d& p : piece.positions) p = eyewear.head_from_frame * p;
    for (Eigen::Vector3d& n : piece.normals) n = eyewear.head_from_frame.linear() * n;
    Append(mesh, piece);
  }
  return mesh;
}

// Light by rays from one point. `turn` rotates the set about the normal.
Light Gather(const ShadingScene& scene, const Environment& environment, const SurfacePoint& point,
             const DirectionSet& set, float turn) {
  const Eigen::Matrix3f basis =
      BasisAbout(point.normal) *
      Eigen::AngleAxisf(turn, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3f world = scene.world_from_head * basis;
  const Eigen::Vector3f origin = point.position + kLift_mm * point.normal;
  Light light;
  RayPacket packet;
  for (std::size_t first = 0; first < set.directions.size(); first += RayPacket::kSize) {
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      const bool valid = first + k < set.directions.size();
      const Eigen::Vector3f d = basis * set.directions[valid ? first + k : first];
      packet.Choose(k, valid);
      packet.Set(k, origin, d);
    }
    scene.rays.Occluded16(RaySet::kFrame, packet);
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      if (!packet.valid[k]) continue;
      const float weight = set.weights.empty() ? 1 : set.weights[first + k];
      const Eigen::Vector3f l = weight * environment.Radiance(world * set.directions[first + k]);
      light.without += l;
      if (packet.far[k] >= 0) light.with += l;
    }
  }
  return light;
}

// Cosine-weighted points of the R2 sequence (Roberts 2018).
DirectionSet LowDiscrepancy(int rays) {
  constexpr double kG = 1.32471795724474602596;
  DirectionSet set;
  for (int i = 0; i < rays; ++i) {
    const double u = std::fmod(0.5 + (i + 1) / kG, 1), v = std::fmod(0.5 + (i + 1) / (kG * kG), 1);
    const double r = std::sqrt(u), angle = 2 * kPi * v;
    set.directions.emplace_back(float(r * std::cos(angle)), float(r * std::sin(angle)),
                                float(std::sqrt(1 - u)));
  }
  return set;
}

// Directions where the light is: texels of the environment by their power.
class LightSampler {
 public:
  explicit LightSampler(const Environment& environment)
      : environment_(environment), width_(environment.map().width) {
    const ImageRgbF& map = environment.map();
    double sum = 0;
    for (int y = 0; y < map.height; ++y) {
      const double band = std::sin(kPi * (y + 0.5) / map.height);
      for (int x = 0; x < map.width; ++x) {
        const float* p = map.at(x, y);
        sum += band * double(p[0] + p[1] + p[2]);
        cumulative_.push_back(sum);
      }
    }
    // Solid angle of a texel at the equator.
    texel_sr_ = 2 * kPi * kPi / (double(map.width) * map.height);
  }
  // World direction for (u, v) in [0, 1)^2.
  Eigen::Vector3f Sample(double u, double v) const {
    const double wanted = u * cumulative_.back();
    const std::size_t i = std::size_t(
        std::upper_bound(cumulative_.begin(), cumulative_.end(), wanted) - cumulative_.begin());
    const double before = i > 0 ? cumulative_[i - 1] : 0;
    const double along = (wanted - before) / (cumulative_[i] - before);
    const std::size_t row = i / std::size_t(width_), column = i % std::size_t(width_);
    return environment_.Direction(double(column) + along, double(row) + v);
  }
  // Density per steradian.
  double Density(const Eigen::Vector3f& direction) const {
    const ImageRgbF& map = environment_.map();
    const Eigen::Vector3f d = direction.normalized();
    const double lat = std::asin(std::clamp(double(d.y()), -1.0, 1.0));
    const double lon = std::atan2(-double(d.x()), double(d.z()));
    const int x = std::clamp(int((lon / (2 * kPi) + 0.5) * map.width), 0, map.width - 1);
    const int y = std::clamp(int((0.5 - lat / kPi) * map.height), 0, map.height - 1);
    const float* p = map.at(x, y);
    return double(p[0] + p[1] + p[2]) / (cumulative_.back() * texel_sr_);
  }

 private:
  const Environment& environment_;
  int width_;
  std::vector<double> cumulative_;
  double texel_sr_;
};

// Half the rays where the light is, half by the cosine, weighted by the balance heuristic (Veach
// 1997). The same world directions serve all points with one rotation.
Light GatherImportance(const ShadingScene& scene, const Environment& environment,
                       const LightSampler& sampler, const DirectionSet& cosine,
                       const std::vector<Eigen::Vector3f>& lit, const SurfacePoint& point,
                       float turn) {
  const Eigen::Matrix3f basis =
      BasisAbout(point.normal) *
      Eigen::AngleAxisf(turn, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  const Eigen::Vector3f origin = point.position + kLift_mm * point.normal;
  const Eigen::Matrix3f head_from_world = scene.world_from_head.transpose();
  Light light;
  RayPacket packet;
  std::size_t filled = 0;
  std::array<Eigen::Vector3f, RayPacket::kSize> value;
  const auto flush = [&] {
    for (std::size_t k = filled; k < RayPacket::kSize; ++k) packet.Choose(k, false);
    scene.rays.Occluded16(RaySet::kFrame, packet);
    for (std::size_t k = 0; k < filled; ++k) {
      light.without += value[k];
      if (packet.far[k] >= 0) light.with += value[k];
    }
    filled = 0;
  };
  const double total = double(cosine.directions.size() + lit.size());
  const double share = double(lit.size()) / total;
  const auto add = [&](const Eigen::Vector3f& d) {
    const double c = double(d.dot(point.normal));
    if (c <= 0) return;
    const Eigen::Vector3f world = scene.world_from_head * d;
    const double density = (1 - share) * c / kPi + share * sampler.Density(world);
    value[filled] = float(c / density) * environment.Radiance(world);
    packet.Choose(filled, true);
    packet.Set(filled, origin, d);
    if (++filled == RayPacket::kSize) flush();
  };
  for (const Eigen::Vector3f& d : cosine.directions) add(basis * d);
  for (const Eigen::Vector3f& d : lit) add(head_from_world * d);
  if (filled > 0) flush();
  return light;
}

// Light of the face's vertices as harmonics, with and without the frame (Sloan et al. 2002).
struct Transfer {
  std::vector<Harmonics> with, without;
};
Transfer BakeTransfer(const ShadingScene& scene, const TriangleMesh& face, int directions) {
  const std::vector<Eigen::Vector3f> sphere = SphereDirections(directions);
  std::vector<Harmonics> values;
  for (const Eigen::Vector3f& d : sphere) values.push_back(EvaluateHarmonics(d));
  const float cell = float(4 * kPi) / float(directions);
  Transfer transfer;
  for (std::size_t i = 0; i < face.positions.size(); ++i) {
    const Eigen::Vector3f n = face.normals[i].cast<float>();
    const Eigen::Vector3f origin = face.positions[i].cast<float>() + kLift_mm * n;
    Harmonics with{}, without{};
    for (std::size_t k = 0; k < sphere.size(); ++k) {
      const float c = sphere[k].dot(n);
      if (c <= 0) continue;
      const bool blocked = scene.rays.Occluded(RaySet::kFrame, origin, sphere[k], 0,
                                               std::numeric_limits<float>::infinity());
      for (std::size_t j = 0; j < kHarmonics; ++j) {
        const float term = cell * c * values[k][j];
        without[j] += term;
        if (!blocked) with[j] += term;
      }
    }
    transfer.with.push_back(with);
    transfer.without.push_back(without);
  }
  return transfer;
}

Result<ShadingScene> Prepare(const WornScene& worn) {
  TriangleMesh frame = FrameInHead(worn.eyewear);
  LG_ASSIGN(EmbreeScene rays, EmbreeScene::Build(worn.face, worn.occluder, frame));
  ShadingScene scene{std::move(rays), std::move(frame), {}, {}, 0};
  scene.world_from_head =
      (worn.options.world_from_camera * worn.camera_from_head.rotation()).cast<float>();
  return scene;
}

// Skin that pixels see and the frame shades: where `touched` says so.
void FindPoints(const WornScene& worn, const BakedShadow& baked, ShadingScene& scene) {
  const Eigen::Isometry3d head_from_camera = worn.camera_from_head.inverse();
  const Eigen::Vector3f eye = head_from_camera.translation().cast<float>();
  std::vector<SkinPoint> all;
  for (int y = 0; y < worn.camera.height; ++y) {
    for (int x = 0; x < worn.camera.width; ++x) {
      const Eigen::Vector3f d =
          (head_from_camera.linear() * worn.camera.Direction(x + 0.5, y + 0.5))
              .normalized()
              .cast<float>();
      const SceneHit hit =
          scene.rays.Intersect(RaySet::kAll, eye, d, 0, std::numeric_limits<float>::infinity());
      if (hit.object != SceneObject::kFace || !baked.touched(hit.triangle)) continue;
      const Eigen::Vector3i& t = worn.face.triangles[hit.triangle];
      const Eigen::Vector3d normal =
          (1 - double(hit.u) - double(hit.v)) * worn.face.normals[std::size_t(t[0])] +
          double(hit.u) * worn.face.normals[std::size_t(t[1])] +
          double(hit.v) * worn.face.normals[std::size_t(t[2])];
      all.push_back({{eye + hit.distance * d, normal.normalized().cast<float>()},
                     hit.triangle,
                     hit.u,
                     hit.v});
    }
  }
  scene.shaded_pixels = long(all.size());
  // Spread by a step that no row's length divides.
  const std::size_t count = std::min(kMostPoints, all.size());
  for (std::size_t i = 0; i < count; ++i) {
    scene.points.push_back(all[std::size_t(double(i) * double(all.size()) / double(count))]);
  }
}

float Turn(std::size_t i) {
  return float(2 * kPi) * float(i * 37 % kRotations) / float(kRotations);
}

}  // namespace

Result<CostStudy> ShadingStudy(const WornScene& worn, const CostOptions& options) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  LG_ASSIGN(ShadingScene scene, Prepare(worn));
  ShadowOptions shadow;
  shadow.sees_face = false;
  shadow.spacing_near_mm = worn.options.shadow_spacing_mm;
  shadow.spacing_far_mm = 4 * worn.options.shadow_spacing_mm;
  {
    const BakedShadow any = BakedShadow::Bake(scene.rays, worn.face, scene.frame, shadow);
    FindPoints(worn, any, scene);
  }
  if (scene.points.empty()) return Failure("cost: the frame of this scene shades no pixel");

  const std::vector<SkinPoint>& points = scene.points;
  std::vector<Eigen::Vector3f> truth;
  const DirectionSet many{HemisphereStrata(kReferenceRays, 99), {}};
  for (const SkinPoint& p : points) {
    truth.push_back(Gather(scene, worn.environment, p.at, many, 0).Ratio());
  }

  CostStudy study;
  study.name = "shading";
  study.title = "Shadow of the frame on the face, frame alone";
  study.reference = fmt::format("{} stratified rays at each of {} points of the {} pixels shaded",
                                kReferenceRays, points.size(), scene.shaded_pixels);
  study.time_unit = "ms/frame";
  study.ms_per_frame = 1;
  study.units = {{"ratio", "of the shadow's factor, one thread"}};

  std::vector<Eigen::Vector3f> found(points.size());
  // work: all points once, and what a frame needs besides; the part that grows with the pixels
  // counts as often as there are pixels.
  const auto add = [&](const char* method, const std::string& parameter,
                       const std::function<void()>& a_frame, const std::function<void()>& a_point,
                       const std::string& note) {
    const Timing per_frame = a_frame ? TimeOf(a_frame, options.stopwatch) : Timing{};
    const Timing per_point = TimeOf(a_point, options.stopwatch);
    const double scale = double(scene.shaded_pixels) / double(points.size());
    CostPoint point;
    point.method = method;
    point.parameter = parameter;
    point.note = note;
    point.time = 1e-6 * (per_frame.median_ns + scale * per_point.median_ns);
    point.time_spread = 1e-6 * (per_frame.spread_ns + scale * per_point.spread_ns);
    double squares = 0, worst = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3f error = (found[i] - truth[i]).cwiseAbs();
      squares += double(error.squaredNorm()) / 3;
      worst = std::max(worst, double(error.maxCoeff()));
    }
    point.errors = {std::sqrt(squares / double(points.size()))};
    point.worst = {worst};
    study.points.push_back(std::move(point));
  };

  for (const int rays : {16, 64, 160, 256, 1024}) {
    std::vector<DirectionSet> sets;
    for (std::uint32_t seed = 0; seed < kRotations; ++seed) {
      sets.push_back({HemisphereStrata(rays, seed), {}});
    }
    add(
        "rays at every pixel, stratified", fmt::format("{} rays", rays), nullptr,
        [&] {
          for (std::size_t i = 0; i < points.size(); ++i) {
            found[i] =
                Gather(scene, worn.environment, points[i].at, sets[i % kRotations], 0).Ratio();
          }
        },
        "");
  }
  for (const int rays : {16, 64, 160, 256, 1024}) {
    const DirectionSet set = LowDiscrepancy(rays);
    add(
        "rays at every pixel, low discrepancy", fmt::format("{} rays", rays), nullptr,
        [&] {
          for (std::size_t i = 0; i < points.size(); ++i) {
            found[i] = Gather(scene, worn.environment, points[i].at, set, Turn(i)).Ratio();
          }
        },
        "");
  }
  const LightSampler sampler(worn.environment);
  for (const int rays : {16, 64, 160, 256, 1024}) {
    const DirectionSet set = LowDiscrepancy(rays / 2);
    // Sets of lit directions, so that neighbours do not share their error.
    std::vector<std::vector<Eigen::Vector3f>> lit(kRotations);
    for (std::uint32_t r = 0; r < kRotations; ++r) {
      const int others = rays - rays / 2;
      for (int i = 0; i < others; ++i) {
        const double u = std::fmod((i + double(r) / kRotations) / double(others), 1);
        const double v = std::fmod(0.5 + std::numbers::phi * (i + 1) + r * 0.123, 1);
        lit[r].push_back(sampler.Sample(u, v));
      }
    }
    add(
        "rays at every pixel, where the light is", fmt::format("{} rays", rays), nullptr,
        [&] {
          for (std::size_t i = 0; i < points.size(); ++i) {
            found[i] = GatherImportance(scene, worn.environment, sampler, set, lit[i % kRotations],
                                        points[i].at, Turn(i))
                           .Ratio();
          }
        },
        "");
  }
  for (const int directions : {256, 512, 1024, 2048}) {
    shadow.directions = directions;
    BakedShadow baked = BakedShadow::Bake(scene.rays, worn.face, scene.frame, shadow);
    const Timing bake = TimeOf(
        [&] { baked = BakedShadow::Bake(scene.rays, worn.face, scene.frame, shadow); }, {1, 1, 0});
    const std::vector<Eigen::Vector3f> sphere = SphereDirections(directions);
    const BlurredEnvironment cells = BlurredEnvironment::ForCells(worn.environment, directions);
    std::vector<Eigen::Vector3f> relit;
    const auto relight = [&] {
      relit = baked.Relight(LightAt(sphere, cells, scene.world_from_head, 1));
    };
    relight();
    add(
        "baked visibility", fmt::format("{} directions", directions), relight,
        [&] {
          for (std::size_t i = 0; i < points.size(); ++i) {
            found[i] = baked.Ratio(relit, points[i].triangle, points[i].u, points[i].v);
          }
        },
        fmt::format("baked once in {:.0f} ms", bake.median_ns * 1e-6));
  }
  const std::vector<Eigen::Vector3f> sphere = SphereDirections(1024);
  const BlurredEnvironment cells = BlurredEnvironment::ForCells(worn.environment, 1024);
  Transfer transfer;
  const Timing bake = TimeOf([&] { transfer = BakeTransfer(scene, worn.face, 1024); }, {1, 1, 0});
  for (const int degree : {2, 3, 4}) {
    const std::size_t terms = std::size_t(degree + 1) * std::size_t(degree + 1);
    std::vector<Eigen::Vector3f> relit(worn.face.positions.size());
    const auto relight = [&] {
      const HeadLight light = LightAt(sphere, cells, scene.world_from_head, 1);
      for (std::size_t i = 0; i < relit.size(); ++i) {
        Light l;
        for (std::size_t j = 0; j < terms; ++j) {
          l.with += transfer.with[i][j] * light.harmonics[j].head<3>();
          l.without += transfer.without[i][j] * light.harmonics[j].head<3>();
        }
        relit[i] = l.Ratio();
      }
    };
    relight();
    add(
        "spherical harmonics a vertex", fmt::format("{} terms", terms), relight,
        [&] {
          for (std::size_t i = 0; i < points.size(); ++i) {
            const Eigen::Vector3i& t = worn.face.triangles[points[i].triangle];
            const float u = points[i].u, v = points[i].v;
            found[i] = (1 - u - v) * relit[std::size_t(t[0])] + u * relit[std::size_t(t[1])] +
                       v * relit[std::size_t(t[2])];
          }
        },
        fmt::format("baked once in {:.0f} ms", bake.median_ns * 1e-6));
  }
  MarkFront(study);
  return study;
}

}  // namespace lorgnette::validation
