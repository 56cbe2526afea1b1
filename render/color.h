// SPDX-License-Identifier: Apache-2.0
// Display-encoded 8-bit pixels and linear light, by the sRGB transfer (IEC 61966-2-1).
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/image.h"

namespace lorgnette {

// sRGB transfer of one value: [0, 1] both ways, monotonic; not clamped.
double LinearFromSrgb(double encoded);
double SrgbFromLinear(double linear);

// Linear light of one code value, correctly rounded to float.
float LinearFromCode(std::uint8_t code);
// The same for a run of them.
void LinearFromCodes(const std::uint8_t* codes, std::size_t count, float* linear);
// Code value nearest to a linear value on the encoded scale: what round(255 SrgbFromLinear(x))
// gives. Below 0 and NaN: 0; above 1: 255.
std::uint8_t CodeFromLinear(float linear);
void CodesFromLinear(const float* linear, std::size_t count, std::uint8_t* codes);

// Whole images. DisplayFromLinear(LinearFromDisplay(image)) is `image`, exactly.
ImageRgbF LinearFromDisplay(const ImageRgb8& image);
ImageRgb8 DisplayFromLinear(const ImageRgbF& image);

}  // namespace lorgnette
