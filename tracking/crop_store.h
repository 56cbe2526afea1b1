// SPDX-License-Identifier: Apache-2.0
// Pictures of the face that are looked at again when the whole clip has been seen. The first are
// kept in memory, the rest in a temporary file without a name, so that a long clip needs hardly
// more memory than a short one.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#include "base/image.h"
#include "tracking/face_region.h"

namespace lorgnette {

// A square grey picture of a part of the face in one frame, turned upright.
struct FaceCrop {
  FaceRegion region;
  Image<std::uint8_t, 1> grey;
};

class CropStore {
 public:
  static constexpr std::size_t kInMemory = std::size_t(96) << 20;  // bytes

  explicit CropStore(std::size_t most_bytes_in_memory = kInMemory) : room_(most_bytes_in_memory) {}
  CropStore(const CropStore&) = delete;
  CropStore& operator=(const CropStore&) = delete;

  // Returns the picture's number, counted from 0. Where the file cannot grow (a full disk), the
  // picture stays in memory.
  std::size_t Keep(Image<std::uint8_t, 1> grey);
  // Thread safe as long as nothing is kept meanwhile. Black where the file has lost the picture.
  Image<std::uint8_t, 1> Load(std::size_t number) const;

 private:
  struct Closing {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  struct Place {
    Image<std::uint8_t, 1> grey;  // empty: in the file
    int width = 0, height = 0;
    std::int64_t offset = 0;
  };
  bool Spill(const Image<std::uint8_t, 1>& grey);

  std::size_t room_;  // bytes of memory left
  std::vector<Place> places_;
  std::unique_ptr<std::FILE, Closing> file_;
  std::int64_t end_ = 0;  // of the file
};

// A crop in a store.
class StoredCrop {
 public:
  StoredCrop() = default;
  StoredCrop(FaceCrop crop, std::shared_ptr<CropStore> store)
      : region(crop.region),
        width(crop.grey.width),
        store_(std::move(store)),
        number_(store_->Keep(std::move(crop.grey))) {}

  FaceRegion region;
  int width = 0;  // pixels
  FaceCrop Load() const {
    return {region, store_ ? store_->Load(number_) : Image<std::uint8_t, 1>()};
  }

 private:
  std::shared_ptr<CropStore> store_;
  std::size_t number_ = 0;
};

}  // namespace lorgnette
