// SPDX-License-Identifier: Apache-2.0
// Our images seen as OpenCV matrices, without a copy. For .cc files of tracking only.
#pragma once

#include <opencv2/core.hpp>

#include "base/image.h"

namespace lorgnette {

template <int kChannels>
cv::Mat MatOf(Image<std::uint8_t, kChannels>& image) {
  return cv::Mat(image.height, image.width, CV_8UC(kChannels), image.data.data());
}
// OpenCV has no matrix of constant pixels; the callers only read.
template <int kChannels>
const cv::Mat MatOf(const Image<std::uint8_t, kChannels>& image) {
  return cv::Mat(image.height, image.width, CV_8UC(kChannels),
                 const_cast<std::uint8_t*>(image.data.data()));
}

}  // namespace lorgnette
