// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "optics/trace.h"
#include "render/embree_scene.h"
#include "render/embree_shape.h"
#include "validation/cost/lens_methods.h"

namespace lorgnette::validation {
namespace {

// One surface over a square around the lens, as cells of two triangles.
Result<TriangleMesh> SurfaceMesh(const Lens& lens, bool back, double half_width_mm,
                                 double half_height_mm, int cells) {
  TriangleMesh mesh;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = half_width_mm * (2.0 * i / cells - 1);
      const double y = half_height_mm * (2.0 * j / cells - 1);
      const Ray along{{x, y, -1}, {0, 0, 1}};
      const auto hit = back ? IntersectBack(lens, along) : lens.front.Intersect(along);
      if (!hit) {
        return Failure(fmt::format("lens: a surface has ended at ({:.1f}, {:.1f}) mm", x, y));
      }
      mesh.positions.push_back(hit->point);
      mesh.normals.push_back(hit->normal);
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.emplace_back(a, b, d);
      mesh.triangles.emplace_back(a, d, c);
    }
  }
  return mesh;
}

// Normals as a renderer has them: one a facet, and one a vertex.
struct MeshNormals {
  std::vector<Eigen::Vector3f> facets, vertices;
  std::vector<Eigen::Vector3i> triangles;
  explicit MeshNormals(const TriangleMesh& mesh) : triangles(mesh.triangles) {
    for (const Eigen::Vector3d& n : mesh.normals) vertices.push_back(n.cast<float>());
    for (const Eigen::Vector3i& t : triangles) {
      const Eigen::Vector3d& a = mesh.positions[std::size_t(t[0])];
      const Eigen::Vector3d n = (mesh.positions[std::size_t(t[1])] - a)
                                    .cross(mesh.positions[std::size_t(t[2])] - a)
                                    .normalized();
      facets.push_back(n.cast<float>());
    }
  }
  Eigen::Vector3f At(bool flat, std::uint32_t triangle, float u, float v) const {
    if (flat) return facets[triangle];
    const Eigen::Vector3i& t = triangles[triangle];
    return ((1 - u - v) * vertices[std::size_t(t[0])] + u * vertices[std::size_t(t[1])] +
            v * vertices[std::size_t(t[2])])
        .normalized();
  }
};

// Both surfaces in Embree: packets of 16 against the front, bent, then against the back.
class EmbreeLens {
 public:
  EmbreeLens(double index, const CameraRays& rays) : index_(float(index)), rays_(rays) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (rays.inside(i)) directions_.push_back(rays.direction(i).cast<float>());
    }
    points_.resize(directions_.size());
    exits_.resize(directions_.size());
  }

  // meet(back, packet, normals): traces the packet against a surface and gives the normals there.
  template <typename Meet>
  void Trace(const Meet& meet) {
    constexpr std::size_t kSize = RayPacket::kSize;
    const Eigen::Vector3f eye = rays_.origin().cast<float>();
    RayPacket packet;
    EmbreeShape::Normals normals;
    for (std::size_t first = 0; first < directions_.size(); first += kSize) {
      for (std::size_t k = 0; k < kSize; ++k) {
        const std::size_t i = std::min(first + k, directions_.size() - 1);
        packet.Choose(k, first + k < directions_.size());
        Set(packet, k, eye, directions_[i]);
      }
      meet(false, packet, normals);
      for (std::size_t k = 0; k < kSize; ++k) {
        if (!packet.valid[k]) continue;
        if (packet.object[k] == SceneObject::kNone) {
          packet.Choose(k, false);
          exits_[first + k].setZero();
          continue;
        }
        const Eigen::Vector3f& d = directions_[first + k];
        Set(packet, k, eye + packet.far[k] * d, Bend(d, normals[k], 1 / index_));
      }
      meet(true, packet, normals);
      for (std::size_t k = 0; k < kSize; ++k) {
        if (!packet.valid[k]) continue;
        if (packet.object[k] == SceneObject::kNone) {
          exits_[first + k].setZero();
          continue;
        }
        const Eigen::Vector3f d(packet.dx[k], packet.dy[k], packet.dz[k]);
        points_[first + k] =
            Eigen::Vector3f(packet.ox[k], packet.oy[k], packet.oz[k]) + packet.far[k] * d;
        exits_[first + k] = Bend(d, normals[k], index_);
      }
    }
  }

  std::vector<ExitRay> Answer() const {
    std::vector<ExitRay> exits(rays_.size());
    std::size_t k = 0;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (!rays_.inside(i)) continue;
      exits[i] = rays_.ExitFrom(points_[k].cast<double>(), exits_[k].cast<double>());
      ++k;
    }
    return exits;
  }

 private:
  static void Set(RayPacket& packet, std::size_t k, const Eigen::Vector3f& origin,
                  const Eigen::Vector3f& d) {
    packet.Set(k, origin, d);
    packet.object[k] = SceneObject::kNone;
  }
  // Snell's law; zero on total reflection.
  static Eigen::Vector3f Bend(const Eigen::Vector3f& d, const Eigen::Vector3f& normal, float eta) {
    const float c = d.dot(normal);
    const float after2 = 1 - eta * eta * (1 - c * c);
    if (after2 < 0) return Eigen::Vector3f::Zero();
    return eta * d + (std::copysign(std::sqrt(after2), c) - eta * c) * normal;
  }

  float index_;
  const CameraRays& rays_;
  std::vector<Eigen::Vector3f> directions_, points_, exits_;
};

// Meshes of both surfaces, in one scene.
struct FacetLens {
  EmbreeScene scene;
  MeshNormals front, back;
  EmbreeLens lens;

  void Trace(bool flat) {
    lens.Trace([&](bool at_back, RayPacket& packet, EmbreeShape::Normals& normals) {
      scene.Intersect16(at_back ? RaySet::kFrame : RaySet::kHead, packet);
      for (std::size_t k = 0; k < normals.size(); ++k) {
        if (!packet.valid[k] || packet.object[k] == SceneObject::kNone) continue;
        normals[k] =
            (at_back ? back : front).At(flat, packet.triangle[k], packet.u[k], packet.v[k]);
      }
    });
  }
};

// Room for the rays: they cross the front up to a tenth farther out than they meet its vertex
// plane.
constexpr double kMargin = 0.55;

// The surfaces themselves as shapes of Embree.
Result<LensMethod> UserGeometry(const Lens& lens, const CameraRays& rays) {
  struct Shapes {
    EmbreeShape front, back;
    EmbreeLens lens;
  };
  const auto shape = [&](bool back) {
    const double x = kMargin * rays.view().width_mm, y = kMargin * rays.view().height_mm;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(0, 0), Eigen::Vector2d(x, y), Eigen::Vector2d(x, -y)}) {
      for (const double sign : {-1.0, 1.0}) {
        const auto jet = (back ? lens.back : lens.front).Jet(sign * corner.x(), sign * corner.y());
        const double z = (jet ? jet->z : 0) + (back ? lens.center_thickness_mm : 0);
        box.extend(Eigen::Vector3d(sign * corner.x(), sign * corner.y(), z));
      }
    }
    box.min().z() -= 1;
    box.max().z() += 1;
    return EmbreeShape::Build(
        box.cast<float>(),
        [&lens, back](const Eigen::Vector3f& origin,
                      const Eigen::Vector3f& direction) -> std::optional<EmbreeShape::Hit> {
          const Ray ray{origin.cast<double>(), direction.cast<double>()};
          const auto hit = back ? IntersectBack(lens, ray) : lens.front.Intersect(ray);
          if (!hit) return std::nullopt;
          return EmbreeShape::Hit{float(hit->distance), hit->normal.cast<float>()};
        });
  };
  LG_ASSIGN(EmbreeShape front, shape(false));
  LG_ASSIGN(EmbreeShape back, shape(true));
  const auto shapes = std::make_shared<Shapes>(
      Shapes{std::move(front), std::move(back), EmbreeLens(lens.medium.index_d, rays)});
  return LensMethod{
      "Embree user geometry", "float",
      [shapes] {
        shapes->lens.Trace([&](bool at_back, RayPacket& packet, EmbreeShape::Normals& normals) {
          (at_back ? shapes->back : shapes->front).Intersect16(packet, normals);
        });
      },
      [shapes] {
        return LensAnswer{shapes->lens.Answer(), {}, {}};
      }};
}

}  // namespace

Result<std::vector<LensMethod>> MeshMethods(const Lens& lens, const CameraRays& rays, int most) {
  std::vector<LensMethod> flat, smooth;
  for (int cells = 16; 4 * cells * cells <= most; cells *= 2) {
    const auto mesh = [&](bool back) {
      return SurfaceMesh(lens, back, kMargin * rays.view().width_mm,
                         kMargin * rays.view().height_mm, cells);
    };
    LG_ASSIGN(const TriangleMesh front, mesh(false));
    LG_ASSIGN(const TriangleMesh back, mesh(true));
    LG_ASSIGN(EmbreeScene scene, EmbreeScene::Build(front, TriangleMesh{}, back));
    const auto facets = std::make_shared<FacetLens>(FacetLens{
        std::move(scene), MeshNormals(front), MeshNormals(back), {lens.medium.index_d, rays}});
    const std::string size = fmt::format("{} triangles", 4 * cells * cells);
    for (const bool is_flat : {true, false}) {
      (is_flat ? flat : smooth)
          .push_back({is_flat ? "mesh, flat normals" : "mesh, interpolated normals", size,
                      [facets, is_flat] { facets->Trace(is_flat); },
                      [facets] {
                        return LensAnswer{facets->lens.Answer(), {}, {}};
                      }});
    }
  }
  flat.insert(flat.end(), smooth.begin(), smooth.end());
  LG_ASSIGN(LensMethod user, UserGeometry(lens, rays));
  flat.push_back(std::move(user));
  return flat;
}

}  // namespace lorgnette::validation
