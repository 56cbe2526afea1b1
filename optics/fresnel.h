// SPDX-License-Identifier: Apache-2.0
// Reflection at a bare surface with its polarisation, and what it does to a whole lens: light
// through two surfaces with every internal bounce, and the ghost image of the first two bounces.
//
// Unpolarised reflectance alone: FresnelReflectance in optics/trace.h. Coated surfaces:
// optics/thin_film.h. Source: docs/measurement.md, "Fresnel".
#pragma once

#include <complex>
#include <optional>

#include "base/units.h"
#include "optics/lens.h"

namespace lorgnette {

// Amplitudes of the electric field, s across and p in the plane of incidence; p's sign is that of
// rp = (n2 c1 - n1 c2) / (n2 c1 + n1 c2). Complex past the critical angle, where |r| = 1.
struct FresnelAmplitudes {
  std::complex<double> rs, rp, ts, tp;
};
// Fractions of the power, per polarisation; s: reflected + transmitted = 1, and so for p.
struct PolarizedPower {
  double rs = 0, rp = 0, ts = 0, tp = 0;
  double reflectance() const { return 0.5 * (rs + rp); }
  double transmittance() const { return 0.5 * (ts + tp); }
  // Degree of polarisation of the reflected light, (rs - rp) / (rs + rp); 0 where none reflects.
  double reflected_polarization() const;
};
// cos_incident in [0, 1]; both media lossless.
FresnelAmplitudes Fresnel(double cos_incident, double index_before, double index_after);
PolarizedPower FresnelPower(double cos_incident, double index_before, double index_after);

// Angle of incidence without p reflection; and that past which all is reflected (nullopt when the
// second medium is the denser).
double BrewsterAngle(double index_before, double index_after);
std::optional<double> CriticalAngle(double index_before, double index_after);

// A plate or lens in air at one angle of incidence: `internal` is the transmittance of the glass
// along one pass. Incoherent sum over all bounces, polarisations apart; without absorption at
// normal incidence 2 n / (n^2 + 1).
struct PlatePower {
  double transmitted = 0, reflected = 0;
  double single_pass = 0;  // (1 - R)^2 times internal: what is left without any second bounce
};
PlatePower PlateTransmittance(double cos_incident, double index, double internal = 1);

// The brightest ghost: light that bounces once off each surface inside the lens and then leaves.
struct Ghost {
  Diopters power;                 // back vertex power of that way; thin: F (3 n - 1) / (n - 1)
  double relative_intensity = 0;  // beside the image proper: R_front R_back
};
// About the axis of a spherical lens; a torus takes the mean curvature of each surface.
//   front_reflectance, back_reflectance  inside the glass; the second form is for bare surfaces
Ghost GhostOf(const Lens& lens, double index, double front_reflectance, double back_reflectance);
Ghost GhostOf(const Lens& lens, double index);

}  // namespace lorgnette
