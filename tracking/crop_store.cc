// SPDX-License-Identifier: Apache-2.0
#include "tracking/crop_store.h"

#include <unistd.h>

#include <algorithm>

namespace lorgnette {
namespace {

// All of `size` bytes at `offset`, by pwrite or pread.
template <typename Call, typename Byte>
bool All(Call call, int file, Byte* bytes, std::size_t size, std::int64_t offset) {
  while (size > 0) {
    const ssize_t done = call(file, bytes, size, off_t(offset));
    if (done <= 0) return false;
    bytes += done;
    size -= std::size_t(done);
    offset += done;
  }
  return true;
}

}  // namespace

bool CropStore::Spill(const Image<std::uint8_t, 1>& grey) {
  if (!file_) file_.reset(std::tmpfile());
  if (!file_ || !All(pwrite, fileno(file_.get()), grey.data.data(), grey.data.size(), end_)) {
    return false;
  }
  places_.push_back({{}, grey.width, grey.height, end_});
  end_ += std::int64_t(grey.data.size());
  return true;
}

std::size_t CropStore::Keep(Image<std::uint8_t, 1> grey) {
  const std::size_t number = places_.size();
  if (grey.data.size() > room_ && Spill(grey)) return number;
  room_ -= std::min(room_, grey.data.size());
  const int width = grey.width, height = grey.height;
  places_.push_back({std::move(grey), width, height, 0});
  return number;
}

Image<std::uint8_t, 1> CropStore::Load(std::size_t number) const {
  const Place& place = places_.at(number);
  if (!place.grey.empty() || place.width * place.height == 0) return place.grey;
  Image<std::uint8_t, 1> grey(place.width, place.height);
  if (!All(pread, fileno(file_.get()), grey.data.data(), grey.data.size(), place.offset)) {
    std::fill(grey.data.begin(), grey.data.end(), std::uint8_t{0});
  }
  return grey;
}

}  // namespace lorgnette
