// SPDX-License-Identifier: Apache-2.0
#include "render/embree_scene.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>

#include "base/check.h"
#include "render/embree_shape.h"

namespace lorgnette {
namespace {

RTCGeometry NewGeometry(RTCDevice device, const TriangleMesh& mesh, bool moves) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(geometry, moves ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.positions.size()));
  for (const Eigen::Vector3d& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) *vertices++ = float(p[k]);
  }
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.triangles.size()));
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) *indices++ = std::uint32_t(t[k]);
  }
  rtcCommitGeometry(geometry);
  return geometry;
}

constexpr std::size_t kGeometries = 3;

RTCIntersectContext Context(RTCIntersectContextFlags flags) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = flags;
  return context;
}

// The packet as Embree takes it.
static_assert(offsetof(RayPacket, near) == offsetof(RTCRay16, tnear) &&
              offsetof(RayPacket, far) == offsetof(RTCRay16, tfar) &&
              offsetof(RayPacket, mask) == offsetof(RTCRay16, mask) &&
              offsetof(RayPacket, nx) == offsetof(RTCRayHit16, hit) &&
              offsetof(RayPacket, u) == offsetof(RTCRayHit16, hit.u) &&
              offsetof(RayPacket, object) == offsetof(RTCRayHit16, hit.geomID) &&
              offsetof(RayPacket, valid) == sizeof(RTCRayHit16));
static_assert(RTC_MAX_INSTANCE_LEVEL_COUNT == 1);

void Trace16(RTCScene scene, RayPacket& p) {
  RTCIntersectContext context = Context(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  std::fill_n(p.object, RayPacket::kSize, SceneObject::kNone);
  std::fill_n(p.instance, RayPacket::kSize, RTC_INVALID_GEOMETRY_ID);
  rtcIntersect16(p.valid, scene, &context, reinterpret_cast<RTCRayHit16*>(&p));
}

}  // namespace

struct EmbreeScene::State {
  RTCDevice device = nullptr;
  RTCScene scenes[3] = {nullptr, nullptr, nullptr};                   // by RaySet
  RTCScene occlusion[3] = {nullptr, nullptr, nullptr};                // the same, for Occluded
  RTCGeometry geometries[kGeometries] = {nullptr, nullptr, nullptr};  // by SceneObject
  std::size_t face_vertices = 0;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    for (std::size_t i = 0; i < 3; ++i) {
      if (occlusion[i] && occlusion[i] != scenes[i]) rtcReleaseScene(occlusion[i]);
      if (scenes[i]) rtcReleaseScene(scenes[i]);
    }
    for (RTCGeometry geometry : geometries) {
      if (geometry) rtcReleaseGeometry(geometry);
    }
    if (device) rtcReleaseDevice(device);
  }
  RTCScene scene(RaySet set) const { return scenes[std::size_t(set)]; }
  RTCScene occluder(RaySet set) const { return occlusion[std::size_t(set)]; }
};

EmbreeScene::EmbreeScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&&) noexcept = default;
EmbreeScene::~EmbreeScene() = default;

Result<EmbreeScene> EmbreeScene::Build(const TriangleMesh& face, const TriangleMesh& occluder,
                                       const TriangleMesh& frame) {
  auto state = std::make_unique<State>();
  state->device = rtcNewDevice(nullptr);
  if (!state->device) {
    return Failure(
        fmt::format("Embree cannot be initialised (error {})", int(rtcGetDeviceError(nullptr))));
  }
  state->face_vertices = face.positions.size();
  const TriangleMesh* meshes[kGeometries] = {&face, &occluder, &frame};
  for (std::size_t i = 0; i < kGeometries; ++i) {
    if (!meshes[i]->empty()) state->geometries[i] = NewGeometry(state->device, *meshes[i], i == 0);
  }
  const auto build = [&](bool moves, bool robust, std::initializer_list<SceneObject> objects) {
    RTCScene scene = rtcNewScene(state->device);
    // A scene that moves keeps a tree for each mesh: the face's is refitted, the others stay. Only
    // the lowest quality of the scene does so (measured: 0.1 ms a commit in place of 29); that of
    // the meshes' own trees is theirs.
    rtcSetSceneFlags(scene, (robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE) |
                                (moves ? RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_NONE));
    rtcSetSceneBuildQuality(scene, moves ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
    for (const SceneObject object : objects) {
      if (RTCGeometry geometry = state->geometries[std::size_t(object)]) {
        rtcAttachGeometryByID(scene, geometry, unsigned(object));
      }
    }
    rtcCommitScene(scene);
    return scene;
  };
  // No camera ray slips between two triangles. Rays that bake light, one of hundreds each, may:
  // they take a seventh less time so.
  const auto attach = [&](RaySet set, bool moves, bool own_occlusion,
                          std::initializer_list<SceneObject> objects) {
    RTCScene& scene = state->scenes[std::size_t(set)];
    scene = build(moves, /*robust=*/true, objects);
    state->occlusion[std::size_t(set)] =
        own_occlusion ? build(moves, /*robust=*/false, objects) : scene;
  };
  attach(RaySet::kAll, true, false,
         {SceneObject::kFace, SceneObject::kOccluder, SceneObject::kFrame});
  attach(RaySet::kHead, true, true, {SceneObject::kFace, SceneObject::kOccluder});
  attach(RaySet::kFrame, false, true, {SceneObject::kFrame});
  if (const RTCError error = rtcGetDeviceError(state->device); error != RTC_ERROR_NONE) {
    return Failure(fmt::format("Embree cannot build the scene (error {})", int(error)));
  }
  return EmbreeScene(std::move(state));
}

void EmbreeScene::MoveFace(const std::vector<Eigen::Vector3f>& vertices) {
  LG_CHECK_EQ(vertices.size(), state_->face_vertices);
  RTCGeometry geometry = state_->geometries[std::size_t(SceneObject::kFace)];
  if (!geometry) return;
  auto* out = static_cast<float*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
  for (const Eigen::Vector3f& p : vertices) {
    std::memcpy(out, p.data(), 3 * sizeof(float));
    out += 3;
  }
  rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(geometry);
  // A scene of its own for occlusion pays in the bake of a whole face, not with a few points a
  // frame.
  RTCScene& occluder = state_->occlusion[std::size_t(RaySet::kHead)];
  if (const RTCScene head = state_->scene(RaySet::kHead); occluder != head) {
    rtcReleaseScene(occluder);
    occluder = head;
  }
  tbb::parallel_invoke([&] { rtcCommitScene(state_->scene(RaySet::kAll)); },
                       [&] { rtcCommitScene(state_->scene(RaySet::kHead)); });
}

SceneHit EmbreeScene::Intersect(RaySet set, const Eigen::Vector3f& origin,
                                const Eigen::Vector3f& direction, float near, float far) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit q;
  q.ray = {origin.x(), origin.y(), origin.z(), near, direction.x(), direction.y(), direction.z(), 0,
           far,        ~0u,        0,          0};
  q.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  q.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->scene(set), &context, &q);
  if (q.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {SceneObject(q.hit.geomID), q.hit.primID, q.ray.tfar, q.hit.u, q.hit.v};
}

bool EmbreeScene::Occluded(RaySet set, const Eigen::Vector3f& origin,
                           const Eigen::Vector3f& direction, float near, float far) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = {
      origin.x(), origin.y(), origin.z(), near, direction.x(), direction.y(), direction.z(), 0,
      far,        ~0u,        0,          0};
  rtcOccluded1(state_->occluder(set), &context, &ray);
  return ray.tfar < 0;
}

void EmbreeScene::Intersect16(RaySet set, RayPacket& packet) const {
  Trace16(state_->scene(set), packet);
}

void EmbreeScene::Occluded16(RaySet set, RayPacket& packet) const {
  // Rays of a hemisphere: measured 20 per cent faster so than as a coherent packet.
  RTCIntersectContext context = Context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  rtcOccluded16(packet.valid, state_->occluder(set), &context,
                reinterpret_cast<RTCRay16*>(&packet));
}

struct EmbreeShape::State {
  Meet meet;
  Eigen::AlignedBox3f box;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  State(Meet m, const Eigen::AlignedBox3f& b) : meet(std::move(m)), box(b) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  static void Bounds(const RTCBoundsFunctionArguments* a) {
    const Eigen::AlignedBox3f& box = static_cast<const State*>(a->geometryUserPtr)->box;
    *a->bounds_o = {box.min().x(), box.min().y(), box.min().z(), 0,
                    box.max().x(), box.max().y(), box.max().z(), 0};
  }

  static void Intersect(const RTCIntersectFunctionNArguments* a) {
    const State* self = static_cast<const State*>(a->geometryUserPtr);
    RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
    RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
    for (unsigned i = 0; i < a->N; ++i) {
      if (a->valid[i] != -1) continue;
      const auto hit = self->meet({RTCRayN_org_x(rays, a->N, i), RTCRayN_org_y(rays, a->N, i),
                                   RTCRayN_org_z(rays, a->N, i)},
                                  {RTCRayN_dir_x(rays, a->N, i), RTCRayN_dir_y(rays, a->N, i),
                                   RTCRayN_dir_z(rays, a->N, i)});
      if (!hit || hit->distance <= RTCRayN_tnear(rays, a->N, i) ||
          hit->distance >= RTCRayN_tfar(rays, a->N, i)) {
        continue;
      }
      RTCRayN_tfar(rays, a->N, i) = hit->distance;
      RTCHitN_Ng_x(hits, a->N, i) = hit->normal.x();
      RTCHitN_Ng_y(hits, a->N, i) = hit->normal.y();
      RTCHitN_Ng_z(hits, a->N, i) = hit->normal.z();
      RTCHitN_primID(hits, a->N, i) = a->primID;
      RTCHitN_geomID(hits, a->N, i) = unsigned(SceneObject::kFace);
    }
  }
};

EmbreeShape::EmbreeShape(std::unique_ptr<State> state) : state_(std::move(state)) {}
EmbreeShape::EmbreeShape(EmbreeShape&&) noexcept = default;
EmbreeShape& EmbreeShape::operator=(EmbreeShape&&) noexcept = default;
EmbreeShape::~EmbreeShape() = default;

Result<EmbreeShape> EmbreeShape::Build(const Eigen::AlignedBox3f& box, Meet meet) {
  auto state = std::make_unique<State>(std::move(meet), box);
  state->device = rtcNewDevice(nullptr);
  if (state->device == nullptr) {
    return Failure(
        fmt::format("Embree cannot be initialised (error {})", int(rtcGetDeviceError(nullptr))));
  }
  state->scene = rtcNewScene(state->device);
  RTCGeometry geometry = rtcNewGeometry(state->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, state.get());
  rtcSetGeometryBoundsFunction(geometry, State::Bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, State::Intersect);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(state->scene, geometry, unsigned(SceneObject::kFace));
  rtcReleaseGeometry(geometry);
  rtcCommitScene(state->scene);
  if (const RTCError error = rtcGetDeviceError(state->device); error != RTC_ERROR_NONE) {
    return Failure(fmt::format("Embree cannot build a shape (error {})", int(error)));
  }
  return EmbreeShape(std::move(state));
}

void EmbreeShape::Intersect16(RayPacket& p, Normals& normals) const {
  Trace16(state_->scene, p);
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = {p.nx[i], p.ny[i], p.nz[i]};
}

}  // namespace lorgnette
