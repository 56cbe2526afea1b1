// SPDX-License-Identifier: Apache-2.0
// The wavelengths that the effect of dispersion traces, and how far apart they end.
#pragma once

#include <vector>

namespace lorgnette {

// Dominant wavelengths of the Rec.709 primaries (their chromaticities against D65's), R, G, B.
inline constexpr double kChannel_nm[3] = {611.4, 549.1, 464.2};

// One traced wavelength; a channel is the mean of those in its own band.
struct ColourBand {
  int channel;  // 0 R, 1 G, 2 B
  double nm;
};

// `wavelengths` of them, a multiple of 3, in the order of the channels.
std::vector<ColourBand> ColourBands(int wavelengths);

}  // namespace lorgnette
