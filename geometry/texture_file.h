// SPDX-License-Identifier: Apache-2.0
// Pictures of materials, from the bytes of PNG, JPEG, BMP or TGA.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "geometry/frame_material.h"

namespace lorgnette {

// Fails, naming `name`, where the bytes are no such picture or it is larger than 8192 x 8192.
Result<Texture> DecodeTexture(std::string_view bytes, const std::string& name);

// Whether what a picture says of its own parts fits into its bytes, as far as the decoder trusts
// it.
bool PictureFits(std::string_view bytes);

}  // namespace lorgnette
