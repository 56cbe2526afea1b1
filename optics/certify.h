// SPDX-License-Identifier: Apache-2.0
// The gate between design and picture: rays are traced through a lens and compared with the order.
//
// CertifiedLens has no public constructor; only Certify makes one, and Eyewear takes nothing else.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "optics/design.h"
#include "optics/lens.h"
#include "optics/prescription.h"

namespace lorgnette {

inline constexpr double kCertificateCamera_mm = 500;

// One quantity of the certificate.
struct Measurement {
  std::string quantity;        // "back vertex power, axis meridian"
  std::string unit;            // "D", "mm", "prism D", "deg", "1"
  double ordered = 0;          // what the order asks for, or the closed form predicts
  double measured = 0;         // by rays
  double tolerance = 0;        // ANSI Z80.1-2015 where it has one, else the stated numerical bound
  double numerical_error = 0;  // bound of the measurement itself
  std::string source;          // where `ordered` and `tolerance` come from
  bool passed() const;
};

struct Certificate {
  std::vector<Measurement> measurements;
  bool passed() const;
};

class CertifiedLens {
 public:
  const Lens& lens() const { return design_.lens; }
  const LensDesign& design() const { return design_; }
  const Certificate& certificate() const { return certificate_; }

 private:
  friend Result<CertifiedLens> Certify(LensDesign design);
  CertifiedLens(LensDesign design, Certificate certificate)
      : design_(std::move(design)), certificate_(std::move(certificate)) {}
  LensDesign design_;
  Certificate certificate_;
};

// Traces through the lens: power in both principal meridians, cylinder, axis, prism, thickness at
// the centre and on the outline, front curve, and the magnification that a camera
// kCertificateCamera before the lens sees at the wearer's iris. Source: docs/optics.md,
// "Certificate". Fails, naming the quantity with both values, when a measurement leaves its
// tolerance.
Result<CertifiedLens> Certify(LensDesign design);

}  // namespace lorgnette
