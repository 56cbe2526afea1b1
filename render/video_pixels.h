// SPDX-License-Identifier: Apache-2.0
// Between decoded planes, packed RGB and the encoder's format. Private to render/.
#pragma once

#include <map>

#include "base/image.h"
#include "base/result.h"
#include "render/video_av.h"

namespace lorgnette {

// Packs the planes of an AV_PIX_FMT_GBRP picture.
ImageRgb8 RgbOfPlanes(const AVFrame& planes);

// RGB pictures (stored orientation) into frames of an encoder's format and of one size.
class PlanesFromRgb {
 public:
  static Result<PlanesFromRgb> Create(int width, int height, AVPixelFormat format,
                                      const av::ColourReading& reading);
  // Writes `rgb` into `frame`, whose buffers are allocated.
  void Fill(const ImageRgb8& rgb, AVFrame& frame);
  // The same for a picture that was edited after decoding, but samples have their `original` values
  // wherever no pixel that a sample covers differs between `edited` and `decoded`: YUV to RGB and
  // back is not exact, and the untouched part of a picture should not pay for it, nor take time.
  // Where formats or sizes differ from those of `original`, as Fill.
  void FillEdited(const ImageRgb8& edited, const ImageRgb8& decoded, const AVFrame& original,
                  AVFrame& frame);

 private:
  PlanesFromRgb(int width, int height, AVPixelFormat format, const av::ColourReading& reading)
      : width_(width), height_(height), format_(format), reading_(reading) {}
  // Makes the scaler for so many rows, unless it is there.
  Status Prepare(int rows);
  void FillRows(const ImageRgb8& rgb, int first, int rows, AVFrame& frame);

  int width_, height_;
  AVPixelFormat format_;
  av::ColourReading reading_;
  std::map<int, av::Scaler> scalers_;  // by rows
};

}  // namespace lorgnette
