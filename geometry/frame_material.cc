// SPDX-License-Identifier: Apache-2.0
#include "geometry/frame_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lorgnette {
namespace {

// Linear values of the 256 encoded ones.
const std::array<float, 256>& LinearTable() {
  static const std::array<float, 256> kTable = [] {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = LinearFromSrgb(float(i) / 255.0f);
    return table;
  }();
  return kTable;
}

int Inside(int i, int size, bool clamp) {
  if (clamp) return std::clamp(i, 0, size - 1);
  return ((i % size) + size) % size;
}

template <typename Decode>
Eigen::Vector4f Bilinear(const Texture& texture, const Eigen::Vector2f& uv, const Decode& decode) {
  const ImageRgba8& image = texture.image;
  if (image.empty() || !uv.allFinite()) return Eigen::Vector4f::Ones();
  // Wrapped first: a far coordinate keeps its fraction.
  const auto wrapped = [](float t, bool clamp) {
    return clamp ? std::clamp(t, 0.0f, 1.0f) : t - std::floor(t);
  };
  const float x = wrapped(uv.x(), texture.clamp_u) * float(image.width) - 0.5f;
  const float y = wrapped(uv.y(), texture.clamp_v) * float(image.height) - 0.5f;
  const int i = int(std::floor(x)), j = int(std::floor(y));
  const float s = x - float(i), t = y - float(j);
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (int b = 0; b < 2; ++b) {
    for (int a = 0; a < 2; ++a) {
      const std::uint8_t* texel = image.at(Inside(i + a, image.width, texture.clamp_u),
                                           Inside(j + b, image.height, texture.clamp_v));
      sum += (a == 0 ? 1 - s : s) * (b == 0 ? 1 - t : t) * decode(texel);
    }
  }
  return sum;
}

Eigen::Vector4f DecodeColor(const std::uint8_t* texel) {
  const auto& linear = LinearTable();
  return {linear[texel[0]], linear[texel[1]], linear[texel[2]], float(texel[3]) / 255.0f};
}

}  // namespace

float LinearFromSrgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

Eigen::Vector4f SampleTexture(const Texture& texture, const Eigen::Vector2f& uv) {
  return Bilinear(texture, uv, [](const std::uint8_t* t) {
    return Eigen::Vector4f(Eigen::Vector4f(float(t[0]), float(t[1]), float(t[2]), float(t[3])) /
                           255.0f);
  });
}

Eigen::Vector4f SampleColor(const Texture& texture, const Eigen::Vector2f& uv) {
  return Bilinear(texture, uv, DecodeColor);
}

Eigen::Vector3f MeanColor(const Texture& texture) {
  if (texture.image.empty()) return Eigen::Vector3f::Ones();
  Eigen::Vector3d sum(0, 0, 0);
  for (std::size_t i = 0; i < texture.image.data.size(); i += 4) {
    sum += DecodeColor(texture.image.data.data() + i).head<3>().cast<double>();
  }
  return (sum / (double(texture.image.data.size()) / 4)).cast<float>();
}

PbrPoint EvaluatePbr(const PbrMaterial& material, const Eigen::Vector2f& uv) {
  PbrPoint point{material.base_color, material.alpha, material.metallic, material.roughness,
                 material.transmission};
  if (material.base_color_texture) {
    const Eigen::Vector4f color = SampleColor(*material.base_color_texture, uv);
    point.base_color = point.base_color.cwiseProduct(color.head<3>());
    point.alpha *= color.w();
  }
  if (material.metallic_roughness_texture) {
    const Eigen::Vector4f both = SampleTexture(*material.metallic_roughness_texture, uv);
    point.roughness *= both.y();
    point.metallic *= both.z();
  }
  if (material.transmission_texture) {
    point.transmission *= SampleTexture(*material.transmission_texture, uv).x();
  }
  return point;
}

float LobeExponent(float roughness) {
  const float a = std::clamp(roughness * roughness, 0.03f, 1.0f);
  return std::clamp(2 / (a * a) - 2, 1.0f, 1000.0f);
}

FrameMaterial PhongLike(PbrMaterial material) {
  Eigen::Vector3f base = material.base_color;
  if (material.base_color_texture) {
    base = base.cwiseProduct(MeanColor(*material.base_color_texture));
  }
  const float metal = std::clamp(material.metallic, 0.0f, 1.0f);
  const float mirrored = std::pow((material.ior - 1) / (material.ior + 1), 2.0f);
  FrameMaterial phong;
  phong.diffuse = base * (1 - metal) + base * (0.25f * metal);
  phong.specular = Eigen::Vector3f::Constant(mirrored * (1 - metal)) + base * (0.75f * metal);
  phong.shininess = LobeExponent(material.roughness);
  phong.pbr = std::make_shared<const PbrMaterial>(std::move(material));
  return phong;
}

}  // namespace lorgnette
