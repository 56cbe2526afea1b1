// SPDX-License-Identifier: Apache-2.0
#include "tests/validation/mutations/mutations.h"

#include <cmath>
#include <string_view>

#include "optics/base_curve.h"
#include "optics/gaze.h"
#include "optics/lens_kernel.h"
#include "optics/magnification.h"
#include "optics/outline.h"
#include "optics/paraxial.h"
#include "optics/trace.h"
#include "optics/wear.h"
#include "render/compositor.h"
#include "render/environment.h"
#include "render/lighting.h"

namespace lorgnette::mutations {
namespace {

std::string_view active;

bool Is(const char* name) { return active == name; }

}  // namespace

const std::vector<Mutation>& All() {
  static const std::vector<Mutation> kAll = {
      {"swapped-surfaces",
       "front and back power swapped in the thick lens",
       {"V001", "V002", "V003", "V041", "V043", "V060"}},
      {"thickness-not-reduced",
       "the thickness not divided by the index",
       {"V001", "V002", "V041", "V060"}},
      {"oblique-surfaces-commuted",
       "the product of the power matrices in the wrong order",
       {"V042"}},
      {"vertex-sign", "the correction moved the wrong way", {"V006", "V007", "V009"}},
      {"axis-mirrored", "TABO axes read in a right-handed frame", {"V044"}},
      {"shape-factor-dropped", "spectacle magnification without the shape factor", {"V062"}},
      {"camera-at-infinity", "the observer's distance left out", {"V043", "V060"}},
      {"stop-from-the-front", "the eye's centre measured from the front vertex", {"V051", "V044"}},
      {"sagittal-for-tangential", "the two vergences of an oblique pencil swapped", {"V051"}},
      {"radius-for-diameter", "the outline twice as large", {"V045", "V046"}},
      {"vogel-for-the-other-sign", "minus lenses by the rule of plus ones", {"V022"}},
      {"martin-without-cylinder", "the tilt's cylinder along the wrong meridian", {"V012"}},
      {"tilt-arithmetic", "the tilted matrix without its geometric mean", {"V049"}},
      {"flat-normals", "rays refracted on the normals of facets of 1 mm", {"V070", "V071", "V073"}},
      {"half-a-pixel", "pixel centres at whole numbers", {"V070", "V071"}},
      {"environment-mirrored", "columns of the environment run the wrong way", {"V080"}},
      {"back-reflection-dropped", "no light from the back surface", {"V080"}},
      {"energy-lost", "reflectances that are not taken from the transmitted light", {"V081"}},
      {"no-shadow", "the frame hides no light", {"V082"}},
      {"index-one-per-cent-off", "n_e taken for n_d in the kernel", {"V070", "V071"}},
  };
  return kAll;
}

Active::Active(const std::string& name) {
  for (const Mutation& one : All()) {
    if (name == one.name) active = one.name;
  }
}
Active::~Active() { active = {}; }

}  // namespace lorgnette::mutations

// --- the wrappers
// ------------------------------------------------------------------------------------ Real_X is
// the program's function, Wrap_X stands before it. A method takes its object first.

namespace lorgnette {
namespace {

using mutations::Is;
using Matrix2 = Eigen::Matrix2d;

#define LG_REAL(mangled) asm("__real_" mangled)
#define LG_WRAP(mangled) asm("__wrap_" mangled) __attribute__((used))

}  // namespace

#define LG_THICK "_ZN9lorgnette14ParaxialSystem9ThickLensENS_8DioptersES1_dd"
ParaxialSystem RealThick(Diopters front, Diopters back, double t, double n) LG_REAL(LG_THICK);
ParaxialSystem WrapThick(Diopters front, Diopters back, double t, double n) LG_WRAP(LG_THICK);
ParaxialSystem WrapThick(Diopters front, Diopters back, double t, double n) {
  if (Is("swapped-surfaces")) return RealThick(back, front, t, n);
  if (Is("thickness-not-reduced")) return RealThick(front, back, t, 1);
  return RealThick(front, back, t, n);
}

#define LG_OBLIQUE \
  "_ZN9lorgnette16AstigmaticSystem9ThickLensERKN5Eigen6MatrixIdLi2ELi2ELi0ELi2ELi2EEES5_dd"
AstigmaticSystem RealOblique(const Matrix2& front, const Matrix2& back, double t, double n)
    LG_REAL(LG_OBLIQUE);
AstigmaticSystem WrapOblique(const Matrix2& front, const Matrix2& back, double t, double n)
    LG_WRAP(LG_OBLIQUE);
AstigmaticSystem WrapOblique(const Matrix2& front, const Matrix2& back, double t, double n) {
  AstigmaticSystem system = RealOblique(front, back, t, n);
  if (Is("oblique-surfaces-commuted")) system.c_D.transposeInPlace();
  return system;
}

#define LG_MOVED "_ZN9lorgnette14MovedTowardEyeENS_8DioptersEd"
Diopters RealMoved(Diopters power, double mm) LG_REAL(LG_MOVED);
Diopters WrapMoved(Diopters power, double mm) LG_WRAP(LG_MOVED);
Diopters WrapMoved(Diopters power, double mm) {
  return RealMoved(power, Is("vertex-sign") ? -mm : mm);
}

#define LG_MATRIX "_ZN9lorgnette15LensFrameMatrixERKNS_11PowerVectorE"
Matrix2 RealMatrix(const PowerVector& power) LG_REAL(LG_MATRIX);
Matrix2 WrapMatrix(const PowerVector& power) LG_WRAP(LG_MATRIX);
Matrix2 WrapMatrix(const PowerVector& power) {
  if (Is("axis-mirrored")) return RealMatrix({power.mean, -power.j0, -power.j45});
  return RealMatrix(power);
}

#define LG_WEARER "_ZN9lorgnette22SpectacleMagnificationERKNS_14ParaxialSystemEd"
double RealWearer(const ParaxialSystem& system, double pupil_mm) LG_REAL(LG_WEARER);
double WrapWearer(const ParaxialSystem& system, double pupil_mm) LG_WRAP(LG_WEARER);
double WrapWearer(const ParaxialSystem& system, double pupil_mm) {
  if (Is("shape-factor-dropped")) return PowerFactor(system.BackVertexPower(), pupil_mm);
  return RealWearer(system, pupil_mm);
}

#define LG_OBSERVER \
  "_ZN9lorgnette16ObserverParaxialERKNS_14ParaxialSystemEdRKNS_16ObserverGeometryE"
ObserverView RealObserver(const ParaxialSystem& system, double t, const ObserverGeometry& g)
    LG_REAL(LG_OBSERVER);
ObserverView WrapObserver(const ParaxialSystem& system, double t, const ObserverGeometry& g)
    LG_WRAP(LG_OBSERVER);
ObserverView WrapObserver(const ParaxialSystem& system, double t, const ObserverGeometry& g) {
  return RealObserver(system, t, Is("camera-at-infinity") ? ObserverGeometry{1e12, g.depth_mm} : g);
}

#define LG_ON_AXIS "_ZN9lorgnette7EyePose6OnAxisERKNS_4LensEd"
EyePose RealOnAxis(const Lens& lens, double stop_mm) LG_REAL(LG_ON_AXIS);
EyePose WrapOnAxis(const Lens& lens, double stop_mm) LG_WRAP(LG_ON_AXIS);
EyePose WrapOnAxis(const Lens& lens, double stop_mm) {
  return RealOnAxis(lens, Is("stop-from-the-front") ? stop_mm - lens.center_thickness_mm : stop_mm);
}

#define LG_GAZE "_ZN9lorgnette12EvaluateGazeERKNS_4LensEdRKNS_7EyePoseERKNS_4GazeEd"
GazeVergence RealGaze(const Lens& lens, double n, const EyePose& eye, const Gaze& gaze, double mm)
    LG_REAL(LG_GAZE);
GazeVergence WrapGaze(const Lens& lens, double n, const EyePose& eye, const Gaze& gaze, double mm)
    LG_WRAP(LG_GAZE);
GazeVergence WrapGaze(const Lens& lens, double n, const EyePose& eye, const Gaze& gaze, double mm) {
  GazeVergence found = RealGaze(lens, n, eye, gaze, mm);
  if (Is("sagittal-for-tangential")) std::swap(found.sagittal_D, found.tangential_D);
  return found;
}

#define LG_ROUND "_ZN9lorgnette7Outline5RoundEd"
Outline RealRound(double diameter_mm) LG_REAL(LG_ROUND);
Outline WrapRound(double diameter_mm) LG_WRAP(LG_ROUND);
Outline WrapRound(double diameter_mm) {
  return RealRound(Is("radius-for-diameter") ? 1.2 * diameter_mm : diameter_mm);
}

#define LG_VOGEL "_ZN9lorgnette14VogelBaseCurveENS_8DioptersE"
Diopters RealVogel(Diopters equivalent) LG_REAL(LG_VOGEL);
Diopters WrapVogel(Diopters equivalent) LG_WRAP(LG_VOGEL);
Diopters WrapVogel(Diopters equivalent) {
  return RealVogel(Is("vogel-for-the-other-sign") ? -equivalent : equivalent);
}

#define LG_MARTIN "_ZN9lorgnette12MartinTiltedENS_8DioptersEddNS_11AxisDegreesE"
SphereCylinder RealMartin(Diopters sphere, double tilt, double n, AxisDegrees axis)
    LG_REAL(LG_MARTIN);
SphereCylinder WrapMartin(Diopters sphere, double tilt, double n, AxisDegrees axis)
    LG_WRAP(LG_MARTIN);
SphereCylinder WrapMartin(Diopters sphere, double tilt, double n, AxisDegrees axis) {
  return RealMartin(sphere, tilt, n,
                    Is("martin-without-cylinder") ? AxisDegrees(axis.value() + 90) : axis);
}

#define LG_TILTED "_ZN9lorgnette10ThinTiltedERKN5Eigen6MatrixIdLi2ELi2ELi0ELi2ELi2EEEddd"
Matrix2 RealTilted(const Matrix2& power, double tilt, double axis, double n) LG_REAL(LG_TILTED);
Matrix2 WrapTilted(const Matrix2& power, double tilt, double axis, double n) LG_WRAP(LG_TILTED);
Matrix2 WrapTilted(const Matrix2& power, double tilt, double axis, double n) {
  Matrix2 tilted = RealTilted(power, tilt, axis, n);
  if (Is("tilt-arithmetic")) {
    // The mean of the two factors, 1 and 1 / cos^2, in place of 1 / cos.
    const double c = std::cos(tilt);
    tilted(0, 1) = tilted(1, 0) = tilted(0, 1) * c * 0.5 * (1 + 1 / (c * c));
  }
  return tilted;
}

// Normal of the surface at the middle of the square of 1 mm that holds (x, y).
static Eigen::Vector3d FacetNormal(const Surface& surface, const Eigen::Vector3d& point) {
  const auto jet = surface.Jet(std::floor(point.x()) + 0.5, std::floor(point.y()) + 0.5);
  return jet ? Eigen::Vector3d(-jet->zx, -jet->zy, 1).normalized() : Eigen::Vector3d(0, 0, 1);
}

#define LG_KERNEL \
  "_ZN9lorgnette14TraceLensBatchERKNS_4LensEdRKNS_9RayArraysIKfEEmRKNS_15LensBatchOutputIfEE"
using FloatRays = RayArrays<const float>;
using FloatOutput = LensBatchOutput<float>;
void RealKernel(const Lens& lens, double n, const FloatRays& in, std::size_t count,
                const FloatOutput& out) LG_REAL(LG_KERNEL);
void WrapKernel(const Lens& lens, double n, const FloatRays& in, std::size_t count,
                const FloatOutput& out) LG_WRAP(LG_KERNEL);
void WrapKernel(const Lens& lens, double n, const FloatRays& in, std::size_t count,
                const FloatOutput& out) {
  RealKernel(lens, Is("index-one-per-cent-off") ? 1 + 0.99 * (n - 1) : n, in, count, out);
  if (Is("back-reflection-dropped") && out.second_reflectance != nullptr) {
    for (std::size_t i = 0; i < count; ++i) out.second_reflectance[i] = 0;
  }
  if (Is("energy-lost") && out.first_reflectance != nullptr) {
    for (std::size_t i = 0; i < count; ++i) out.first_reflectance[i] = -out.first_reflectance[i];
  }
  if (!Is("flat-normals")) return;
  for (std::size_t i = 0; i < count; ++i) {
    const Ray ray{{in.ox[i], in.oy[i], in.oz[i]}, {in.dx[i], in.dy[i], in.dz[i]}};
    const auto front = lens.front.Intersect(ray);
    if (!front) continue;
    const auto inside = Refract(ray.direction, FacetNormal(lens.front, front->point), 1 / n);
    if (!inside) continue;
    const auto back = IntersectBack(lens, {front->point, *inside});
    if (!back) continue;
    const auto exit = Refract(*inside, FacetNormal(lens.back, back->point), n);
    if (!exit) continue;
    float* const to[] = {out.exit.ox, out.exit.oy, out.exit.oz,
                         out.exit.dx, out.exit.dy, out.exit.dz};
    for (int k = 0; k < 3; ++k) {
      to[k][i] = float(back->point[k]);
      to[k + 3][i] = float((*exit)[k]);
    }
  }
}

#define LG_RENDER                                                                              \
  "_ZNK9lorgnette10Compositor6RenderERKNS_5ImageIfLi3EEERKNS_6CameraERKN5Eigen9TransformIdLi3" \
  "ELi1ELi0EEEPNS_12RenderCountsEPKNS_14PictureEffectsE"
ImageRgbF RealRender(const Compositor* self, const ImageRgbF& input, const Camera& camera,
                     const Eigen::Isometry3d& pose, RenderCounts* counts,
                     const PictureEffects* effects) LG_REAL(LG_RENDER);
ImageRgbF WrapRender(const Compositor* self, const ImageRgbF& input, const Camera& camera,
                     const Eigen::Isometry3d& pose, RenderCounts* counts,
                     const PictureEffects* effects) LG_WRAP(LG_RENDER);
ImageRgbF WrapRender(const Compositor* self, const ImageRgbF& input, const Camera& camera,
                     const Eigen::Isometry3d& pose, RenderCounts* counts,
                     const PictureEffects* effects) {
  Camera used = camera;
  if (Is("half-a-pixel")) {
    used.cx += 0.5;
    used.cy += 0.5;
  }
  return RealRender(self, input, used, pose, counts, effects);
}

#define LG_RADIANCE "_ZNK9lorgnette11Environment8RadianceERKN5Eigen6MatrixIfLi3ELi1ELi0ELi3ELi1EEE"
Eigen::Vector3f RealRadiance(const Environment* self, const Eigen::Vector3f& d)
    LG_REAL(LG_RADIANCE);
Eigen::Vector3f WrapRadiance(const Environment* self, const Eigen::Vector3f& d)
    LG_WRAP(LG_RADIANCE);
Eigen::Vector3f WrapRadiance(const Environment* self, const Eigen::Vector3f& d) {
  if (Is("environment-mirrored")) return RealRadiance(self, {-d.x(), d.y(), d.z()});
  return RealRadiance(self, d);
}

#define LG_RELIGHT "_ZNK9lorgnette11BakedShadow7RelightERKNS_9HeadLightE"
std::vector<Eigen::Vector3f> RealRelight(const BakedShadow* self, const HeadLight& light)
    LG_REAL(LG_RELIGHT);
std::vector<Eigen::Vector3f> WrapRelight(const BakedShadow* self, const HeadLight& light)
    LG_WRAP(LG_RELIGHT);
std::vector<Eigen::Vector3f> WrapRelight(const BakedShadow* self, const HeadLight& light) {
  std::vector<Eigen::Vector3f> ratios = RealRelight(self, light);
  if (Is("no-shadow")) {
    for (Eigen::Vector3f& ratio : ratios) ratio.setOnes();
  }
  return ratios;
}

}  // namespace lorgnette
