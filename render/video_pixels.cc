// SPDX-License-Identifier: Apache-2.0
#include "render/video_pixels.h"

extern "C" {
#include <libavutil/pixdesc.h>
}

#include <cstring>
#include <vector>

namespace lorgnette {
namespace {

// One plane of samples, each covering a block of 2^log2_w x 2^log2_h pixels.
void RestorePlane(const std::vector<std::uint8_t>& touched, int width, int height, int log2_w,
                  int log2_h, int sample_bytes, const std::uint8_t* from, int from_stride,
                  std::uint8_t* to, int to_stride) {
  const int columns = AV_CEIL_RSHIFT(width, log2_w);
  const int rows = AV_CEIL_RSHIFT(height, log2_h);
  std::vector<std::uint8_t> row(static_cast<std::size_t>(columns));
  for (int r = 0; r < rows; ++r) {
    std::fill(row.begin(), row.end(), std::uint8_t{0});
    for (int y = r << log2_h; y < std::min(height, (r + 1) << log2_h); ++y) {
      const std::uint8_t* line = touched.data() + std::size_t(y) * width;
      for (int x = 0; x < width; ++x) row[x >> log2_w] |= line[x];
    }
    for (int c = 0; c < columns; ++c) {
      if (row[c] == 0) std::memcpy(to + c * sample_bytes, from + c * sample_bytes, sample_bytes);
    }
    from += from_stride;
    to += to_stride;
  }
}

}  // namespace

void FillFromRgb(const ImageRgb8& rgb, SwsContext* scaler, AVFrame& frame) {
  const std::uint8_t* pixels = rgb.data.data();
  const int stride = 3 * rgb.width;
  sws_scale(scaler, &pixels, &stride, 0, rgb.height, frame.data, frame.linesize);
}

bool RestoreUntouched(const ImageRgb8& edited, const ImageRgb8& decoded, const AVFrame& original,
                      AVFrame& frame) {
  bool full_range = false;
  const AVPixelFormat format = av::PlainFormat(frame.format, &full_range);
  const AVPixFmtDescriptor* description = av_pix_fmt_desc_get(format);
  if (av::PlainFormat(original.format, &full_range) != format || description == nullptr ||
      (description->flags & AV_PIX_FMT_FLAG_PLANAR) == 0 ||
      (description->flags & AV_PIX_FMT_FLAG_RGB) != 0 || original.width != frame.width ||
      original.height != frame.height || decoded.data.size() != edited.data.size()) {
    return false;
  }
  const int width = frame.width, height = frame.height;
  std::vector<std::uint8_t> touched(std::size_t(width) * std::size_t(height));
  for (std::size_t i = 0; i < touched.size(); ++i) {
    touched[i] = std::memcmp(&edited.data[3 * i], &decoded.data[3 * i], 3) != 0;
  }
  bool plane_done[4] = {};
  for (int i = 0; i < description->nb_components; ++i) {
    const AVComponentDescriptor& component = description->comp[i];
    const int plane = component.plane;
    if (plane_done[plane]) continue;  // NV12 keeps both chroma components in one
    plane_done[plane] = true;
    const bool chroma = i == 1 || i == 2;
    RestorePlane(touched, width, height, chroma ? description->log2_chroma_w : 0,
                 chroma ? description->log2_chroma_h : 0, component.step, original.data[plane],
                 original.linesize[plane], frame.data[plane], frame.linesize[plane]);
  }
  return true;
}

}  // namespace lorgnette
