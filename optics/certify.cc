// SPDX-License-Identifier: Apache-2.0
#include "optics/certify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "optics/magnification.h"
#include "optics/outline.h"
#include "optics/pencil.h"
#include "optics/power_vector.h"
#include "optics/tolerances.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

// Below this cylinder an axis is noise.
constexpr double kLeastCylinderWithAxis_D = 0.01;
constexpr double kEdgeTolerance_mm = 1e-9;        // rays against sags: the same number twice
constexpr double kSegmentDepth_mm = 4;            // below a segment's top its addition is measured
constexpr double kMagnificationTolerance = 1e-3;  // of the prediction on the axis
constexpr double kLength_mm = 1e-12;              // rounding of a traced distance
constexpr char kAnsi[] = "order; tolerance of ANSI Z80.1-2015";

class Examiner {
 public:
  explicit Examiner(const LensDesign& design)
      : design_(design), order_(design.order), lens_(design.lens), n_(lens_.medium.index_d) {}

  Result<Certificate> Examine() {
    const auto pencil = MeasurePower(lens_, n_);
    if (!pencil) return Failure("certify: a ray near the optical centre does not pass the lens");
    Power(*pencil);
    Prism(*pencil);
    LG_RETURN_IF_ERROR(Addition());
    LG_RETURN_IF_ERROR(Thickness());
    LG_RETURN_IF_ERROR(Magnification());
    return certificate_;
  }

 private:
  LensKind Kind() const {
    return order_.progressive ? LensKind::kProgressive : LensKind::kSingleVision;
  }

  void Add(std::string quantity, std::string unit, double ordered, double measured,
           double tolerance, double numerical_error, std::string source) {
    certificate_.measurements.push_back({std::move(quantity), std::move(unit), ordered, measured,
                                         tolerance, numerical_error, std::move(source)});
  }

  void Power(const PencilPower& pencil) {
    const EyePrescription& rx = order_.rx;
    const Eigen::Vector2d along = LensFrameDirection(rx.axis);
    const Eigen::Vector2d across(-along.y(), along.x());
    const double sphere = rx.sphere.value(), cylinder = rx.cylinder.value();
    const double error = pencil.power_error_D;
    const PowerVector measured = PowerVectorOfLensFrame(pencil.power_D);
    const SphereCylinder form =
        cylinder > 0 ? PlusCylinderForm(measured) : MinusCylinderForm(measured);

    const auto meridian = [&](const char* name, double ordered, const Eigen::Vector2d& u) {
      Add(name, "D", ordered, u.dot(pencil.power_D * u),
          MeridianTolerance(Kind(), Diopters(ordered)), error, kAnsi);
    };
    meridian("back vertex power, axis meridian", sphere, along);
    meridian("back vertex power, across the axis", sphere + cylinder, across);
    Add("cylinder", "D", cylinder, form.cylinder.value(), CylinderTolerance(Kind(), rx.cylinder),
        2 * error, kAnsi);
    if (std::abs(cylinder) >= kLeastCylinderWithAxis_D) {
      const double axis = rx.axis.value();
      const double difference = std::remainder(form.axis.value() - axis, 180.0);
      Add("axis", "deg", axis, axis + difference, AxisTolerance(rx.cylinder),
          DegreesFromRadians(error / std::abs(cylinder)), kAnsi);
    }
  }

  void Prism(const PencilPower& pencil) {
    const EyePrescription& rx = order_.rx;
    const double strongest =
        std::max(std::abs(rx.sphere.value()), std::abs(rx.sphere.value() + rx.cylinder.value()));
    const double tolerance = PrismTolerance(Diopters(strongest));
    Add("prism at the reference point, base in", "prism D", rx.prism_in.value(),
        NasalSign(order_.eye) * pencil.prism.x(), tolerance, pencil.prism_error, kAnsi);
    Add("prism at the reference point, base up", "prism D", rx.prism_up.value(), pencil.prism.y(),
        tolerance, pencil.prism_error, kAnsi);
  }

  // Front power at the near point less that at the vertex, for a multifocal front: vergence of a
  // pencil that a single refraction sends into the lens along the front's normal.
  Status Addition() {
    if (!order_.segment && !order_.progressive) return {};
    const Eigen::Vector2d near =
        order_.progressive ? NearPoint(*order_.progressive, order_.eye)
                           : Eigen::Vector2d(NasalSign(order_.eye) * order_.segment->inset_mm,
                                             order_.segment->top_mm - kSegmentDepth_mm);
    const auto far = MeasureFrontPower(lens_.front, {0, 0}, n_);
    const auto below = MeasureFrontPower(lens_.front, near, n_);
    if (!far || !below) return Failure("certify: no ray enters the front at the near point");
    Add("addition of the front, near point less optical centre", "D", order_.rx.add.value(),
        0.5 * (below->power_D - far->power_D).trace(), AddTolerance(order_.rx.add),
        far->power_error_D + below->power_error_D, kAnsi);
    return {};
  }

  // Distance between the surfaces along a ray parallel to the axis.
  std::optional<double> Gap(const Eigen::Vector2d& p) const {
    const Ray ray{{p.x(), p.y(), -1}, {0, 0, 1}};
    const auto front = lens_.front.Intersect(ray);
    const auto back = IntersectBack(lens_, ray);
    return front && back ? std::optional(back->distance - front->distance) : std::nullopt;
  }

  Status Thickness() {
    const auto center = Gap({0, 0});
    if (!center) return Failure("certify: no ray along the axis meets both surfaces");
    Add("centre thickness", "mm", order_.center_thickness_mm.value_or(lens_.center_thickness_mm),
        *center, kCenterThicknessTolerance_mm, kLength_mm,
        order_.center_thickness_mm ? kAnsi : "design rule; tolerance of ANSI Z80.1-2015");

    const Outline outline = order_.contour_mm.empty() ? Outline::Round(order_.diameter_mm)
                                                      : Outline::FromPolygon(order_.contour_mm);
    std::optional<Eigen::Vector2d> beyond;
    const auto edge = outline.LeastOnRim([&](double x, double y) {
      const auto gap = Gap({x, y});
      if (!gap && !beyond) beyond = Eigen::Vector2d(x, y);
      return gap;
    });
    if (!edge) {
      return Failure(
          fmt::format("certify: the lens ends before its outline, at ({:.2f}, {:.2f}) "
                      "mm from the optical centre",
                      beyond->x(), beyond->y()));
    }
    const double least = edge->value;
    if (least < 0) {
      return Failure(fmt::format("certify: the surfaces cross, the edge is {:.3f} mm", least));
    }
    Add("least edge thickness", "mm", design_.min_edge_thickness_mm, least, kEdgeTolerance_mm,
        kLength_mm, "difference of the sags over the outline; numerical bound");

    // Three points of the front's flattest meridian.
    const Eigen::Matrix2d bend = lens_.front.VertexCurvature();
    const double flattest = 0.5 * std::atan2(2 * bend(0, 1), bend(0, 0) - bend(1, 1)) + 0.5 * kPi;
    const double h = kPencilHeight_mm;
    const auto hit =
        lens_.front.Intersect({{h * std::cos(flattest), h * std::sin(flattest), -1}, {0, 0, 1}});
    if (!hit) return Failure("certify: no ray near the axis meets the front surface");
    const double z = hit->point.z();
    Add("base curve (flattest front meridian, true power)", "D", design_.front_power.value(),
        1000 * (n_ - 1) * 2 * z / (h * h + z * z), kBaseCurveTolerance_D,
        1000 * (n_ - 1) * 2 * kLength_mm / (h * h), "design; tolerance of ANSI Z80.1-2015");
    return {};
  }

  Status Magnification() {
    const ObserverGeometry view{kCertificateCamera_mm,
                                order_.vertex_distance_mm + kEntrancePupilDepth_mm};
    const auto pencil = MeasureObserverMagnification(lens_, n_, view.camera_mm, view.depth_mm);
    if (!pencil) return Failure("certify: no ray from the camera passes the optical centre");
    const Eigen::Matrix2d closed =
        PrismaticObserverMagnification(lens_, n_, view.camera_mm, view.depth_mm);
    const Eigen::Vector2d along = LensFrameDirection(order_.rx.axis);
    const Eigen::Vector2d across(-along.y(), along.x());
    const std::string source = fmt::format(
        "thick-lens closed form, camera {:g} mm before and iris {:g} mm behind the lens; numerical "
        "bound",
        view.camera_mm, view.depth_mm);
    Add("magnification seen by a camera, axis meridian", "1", along.dot(closed * along),
        along.dot(pencil->magnification * along), kMagnificationTolerance, pencil->error, source);
    Add("magnification seen by a camera, across the axis", "1", across.dot(closed * across),
        across.dot(pencil->magnification * across), kMagnificationTolerance, pencil->error, source);
    return {};
  }

  const LensDesign& design_;
  const LensOrder& order_;
  const Lens& lens_;
  double n_;
  Certificate certificate_;
};

}  // namespace

bool Measurement::passed() const { return std::abs(measured - ordered) <= tolerance; }

bool Certificate::passed() const {
  return std::all_of(measurements.begin(), measurements.end(),
                     [](const Measurement& m) { return m.passed(); });
}

Result<CertifiedLens> Certify(LensDesign design) {
  LG_ASSIGN(Certificate certificate, Examiner(design).Examine());
  for (const Measurement& m : certificate.measurements) {
    if (m.passed()) continue;
    return Failure(fmt::format("certify: {}: measured {:.4f} {}, want {:.4f} +- {:.4f}", m.quantity,
                               m.measured, m.unit, m.ordered, m.tolerance));
  }
  return CertifiedLens(std::move(design), std::move(certificate));
}

}  // namespace lorgnette
