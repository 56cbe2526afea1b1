// SPDX-License-Identifier: Apache-2.0
// Between decoded planes, packed RGB and the encoder's format. Private to render/.
#pragma once

#include "base/image.h"
#include "render/video_av.h"

namespace lorgnette {

// Packs the planes of an AV_PIX_FMT_GBRP picture.
ImageRgb8 RgbOfPlanes(const AVFrame& planes);

// Writes `rgb` (stored orientation) into `frame`, whose buffers are allocated, through `scaler`.
void FillFromRgb(const ImageRgb8& rgb, SwsContext* scaler, AVFrame& frame);

// Gives the samples of `frame` their decoded values back wherever no pixel that a sample covers
// differs between `edited` and `decoded` (both in stored orientation): YUV to RGB and back is not
// exact, and the untouched part of a picture should not pay for it.
// Returns whether it could: formats and sizes agree and the format is planar.
bool RestoreUntouched(const ImageRgb8& edited, const ImageRgb8& decoded, const AVFrame& original,
                      AVFrame& frame);

}  // namespace lorgnette
