// SPDX-License-Identifier: Apache-2.0
#include "render/video_pixels.h"

extern "C" {
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <cstring>
#include <vector>

namespace lorgnette {
namespace {

// Which pixels of a picture differ from another of its size: none of most rows.
struct Touched {
  Touched(const ImageRgb8& a, const ImageRgb8& b)
      : width(a.width), row_of(std::size_t(a.height), -1) {
    for (int y = 0; y < a.height; ++y) {
      const std::uint8_t *p = a.at(0, y), *q = b.at(0, y);
      if (std::memcmp(p, q, 3 * std::size_t(width)) == 0) continue;
      row_of[std::size_t(y)] = int(pixels.size() / std::size_t(width));
      pixels.resize(pixels.size() + std::size_t(width));
      std::uint8_t* differs = pixels.data() + pixels.size() - width;
      for (int x = 0; x < width; ++x, p += 3, q += 3) {
        differs[x] = std::uint8_t((p[0] ^ q[0]) | (p[1] ^ q[1]) | (p[2] ^ q[2]));
      }
    }
  }
  // Of row y; null where no pixel differs.
  const std::uint8_t* Row(int y) const {
    const int row = row_of[std::size_t(y)];
    return row < 0 ? nullptr : pixels.data() + std::size_t(row) * std::size_t(width);
  }

  int width;
  std::vector<int> row_of;
  std::vector<std::uint8_t> pixels;
};

// One plane of samples, each covering a block of 2^log2_w x 2^log2_h pixels.
void RestorePlane(const Touched& touched, int log2_w, int log2_h, int sample_bytes,
                  const std::uint8_t* from, int from_stride, std::uint8_t* to, int to_stride) {
  const int width = touched.width, height = int(touched.row_of.size());
  const int columns = AV_CEIL_RSHIFT(width, log2_w);
  const int rows = AV_CEIL_RSHIFT(height, log2_h);
  std::vector<std::uint8_t> row(static_cast<std::size_t>(columns));
  for (int r = 0; r < rows; ++r, from += from_stride, to += to_stride) {
    std::fill(row.begin(), row.end(), std::uint8_t{0});
    bool any = false;
    for (int y = r << log2_h; y < std::min(height, (r + 1) << log2_h); ++y) {
      const std::uint8_t* line = touched.Row(y);
      if (line == nullptr) continue;
      any = true;
      for (int x = 0; x < width; ++x) row[x >> log2_w] |= line[x];
    }
    if (!any) {
      std::memcpy(to, from, std::size_t(columns) * std::size_t(sample_bytes));
      continue;
    }
    for (int c = 0; c < columns;) {  // runs of one kind
      const int first = c;
      while (c < columns && (row[c] == 0) == (row[first] == 0)) ++c;
      if (row[first] != 0) continue;
      std::memcpy(to + first * sample_bytes, from + first * sample_bytes,
                  std::size_t(c - first) * std::size_t(sample_bytes));
    }
  }
}

void RestorePlanes(const Touched& touched, const AVFrame& original, AVFrame& frame) {
  const AVPixFmtDescriptor* description = av_pix_fmt_desc_get(AVPixelFormat(frame.format));
  bool plane_done[4] = {};
  for (int i = 0; i < description->nb_components; ++i) {
    const AVComponentDescriptor& component = description->comp[i];
    const int plane = component.plane;
    if (plane_done[plane]) continue;  // NV12 keeps both chroma components in one
    plane_done[plane] = true;
    const bool chroma = i == 1 || i == 2;
    RestorePlane(touched, chroma ? description->log2_chroma_w : 0,
                 chroma ? description->log2_chroma_h : 0, component.step, original.data[plane],
                 original.linesize[plane], frame.data[plane], frame.linesize[plane]);
  }
}

bool CanRestore(const ImageRgb8& edited, const ImageRgb8& decoded, const AVFrame& original,
                const AVFrame& frame) {
  bool full_range = false;
  const AVPixelFormat format = av::PlainFormat(frame.format, &full_range);
  const AVPixFmtDescriptor* description = av_pix_fmt_desc_get(format);
  return av::PlainFormat(original.format, &full_range) == format && description != nullptr &&
         (description->flags & AV_PIX_FMT_FLAG_PLANAR) != 0 &&
         (description->flags & AV_PIX_FMT_FLAG_RGB) == 0 && original.width == frame.width &&
         original.height == frame.height && decoded.data.size() == edited.data.size();
}

struct Rows {
  int first = 0, count = 0;
};
// The rows to convert for the touched ones to come out as in the whole picture: with what the
// chroma filter reaches beyond them. Few numbers of rows occur, each of which needs a scaler, and
// rows begin where ordered dither does.
Rows RowsToConvert(const Touched& touched) {
  constexpr int kReach = 16, kDither = 8, kStep = 64;
  const int height = int(touched.row_of.size());
  int first = 0, end = height;
  while (first < end && touched.row_of[std::size_t(first)] < 0) ++first;
  while (end > first && touched.row_of[std::size_t(end - 1)] < 0) --end;
  if (first == end) return {};
  Rows rows{std::max(0, first - kReach) / kDither * kDither, height};
  end = std::min(height, end + kReach);
  rows.count = std::min(height, (end - rows.first + kStep - 1) / kStep * kStep);
  if (rows.first + rows.count > height) {
    rows.first = (height - rows.count) / kDither * kDither;
    rows.count = height - rows.first;
  }
  return rows;
}

}  // namespace

ImageRgb8 RgbOfPlanes(const AVFrame& planes) {
  ImageRgb8 rgb(planes.width, planes.height);
  for (int y = 0; y < rgb.height; ++y) {
    const auto row = [&](int plane) { return planes.data[plane] + y * planes.linesize[plane]; };
    const std::uint8_t *green = row(0), *blue = row(1), *red = row(2);
    std::uint8_t* out = rgb.at(0, y);
    for (int x = 0; x < rgb.width; ++x, out += 3) {
      out[0] = red[x];
      out[1] = green[x];
      out[2] = blue[x];
    }
  }
  return rgb;
}

Result<PlanesFromRgb> PlanesFromRgb::Create(int width, int height, AVPixelFormat format,
                                            const av::ColourReading& reading) {
  PlanesFromRgb planes(width, height, format, reading);
  LG_RETURN_IF_ERROR(planes.Prepare(height));
  return planes;
}

Status PlanesFromRgb::Prepare(int rows) {
  if (scalers_.contains(rows)) return {};
  LG_ASSIGN(scalers_[rows], av::ScalerFromRgb(width_, rows, format_, reading_));
  return {};
}

void PlanesFromRgb::FillRows(const ImageRgb8& rgb, int first, int rows, AVFrame& frame) {
  const std::uint8_t* pixels = rgb.at(0, first);
  const int stride = 3 * rgb.width;
  const AVPixFmtDescriptor* description = av_pix_fmt_desc_get(format_);
  std::uint8_t* planes[4] = {};
  for (int p = 0; p < 4; ++p) {
    if (frame.data[p] == nullptr) continue;
    const int row = p == 1 || p == 2 ? first >> description->log2_chroma_h : first;
    planes[p] = frame.data[p] + row * frame.linesize[p];
  }
  sws_scale(scalers_.at(rows).get(), &pixels, &stride, 0, rows, planes, frame.linesize);
}

void PlanesFromRgb::Fill(const ImageRgb8& rgb, AVFrame& frame) { FillRows(rgb, 0, height_, frame); }

void PlanesFromRgb::FillEdited(const ImageRgb8& edited, const ImageRgb8& decoded,
                               const AVFrame& original, AVFrame& frame) {
  if (!CanRestore(edited, decoded, original, frame)) {
    Fill(edited, frame);
    return;
  }
  const Touched touched(edited, decoded);
  if (const Rows rows = RowsToConvert(touched); rows.count > 0) {
    if (Prepare(rows.count)) {
      FillRows(edited, rows.first, rows.count, frame);
    } else {
      Fill(edited, frame);
    }
  }
  RestorePlanes(touched, original, frame);
}

}  // namespace lorgnette
