// SPDX-License-Identifier: Apache-2.0
#include "tracking/network.h"

#include <fmt/format.h>

#include <filesystem>

namespace lorgnette {

Result<OnnxNetwork> OnnxNetwork::Load(const std::string& path, int pixels,
                                      const std::vector<int>& output_sizes) {
  if (!std::filesystem::exists(path)) {
    return Failure(
        fmt::format("{}: got no file, want a converted face network "
                    "(scripts/convert_networks.py makes it)",
                    path));
  }
  OnnxNetwork network;
  std::vector<std::string> names;
  std::vector<cv::Mat> outputs;
  try {
    network.net_ = cv::dnn::readNetFromONNX(path);
    // On one thread: sums that are split among threads round differently on another machine.
    cv::setNumThreads(1);
    network.net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    network.net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    names = network.net_.getUnconnectedOutLayersNames();
    const cv::Mat blank(pixels, pixels, CV_8UC3, cv::Scalar::all(0));
    network.names_ = names;
    outputs = network.Run(blank, 1, 0);
  } catch (const cv::Exception& e) {
    return Failure(fmt::format("{}: not a usable ONNX network: {}", path, e.err));
  }
  network.names_.clear();
  for (const int size : output_sizes) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (int(outputs[i].total()) == size) network.names_.push_back(names[i]);
    }
  }
  if (network.names_.size() != output_sizes.size()) {
    return Failure(fmt::format("{}: got outputs that do not fit, want {} values", path,
                               fmt::join(output_sizes, " and ")));
  }
  return network;
}

std::vector<cv::Mat> OnnxNetwork::Run(const cv::Mat& rgb, double scale, double mean) {
  net_.setInput(cv::dnn::blobFromImage(rgb, scale, rgb.size(), cv::Scalar::all(mean)));
  std::vector<cv::Mat> outputs;
  net_.forward(outputs, names_);
  return outputs;
}

}  // namespace lorgnette
