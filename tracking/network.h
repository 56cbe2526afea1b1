// SPDX-License-Identifier: Apache-2.0
// A converted network behind OpenCV's runtime. For .cc files of tracking only.
#pragma once

#include <opencv2/dnn.hpp>
#include <string>
#include <vector>

#include "base/result.h"

namespace lorgnette {

class OnnxNetwork {
 public:
  // `pixels`: side of the square input (NCHW, three channels). `output_sizes`: number of values of
  // each output wanted; a network without such outputs is refused.
  static Result<OnnxNetwork> Load(const std::string& path, int pixels,
                                  const std::vector<int>& output_sizes);

  // rgb: CV_8UC3 of pixels x pixels; the network sees scale * (value - mean). Outputs in the order
  // of `output_sizes`, continuous floats.
  std::vector<cv::Mat> Run(const cv::Mat& rgb, double scale, double mean);

 private:
  cv::dnn::Net net_;
  std::vector<std::string> names_;
};

}  // namespace lorgnette
