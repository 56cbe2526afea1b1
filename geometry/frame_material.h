// SPDX-License-Identifier: Apache-2.0
// What the surface of a frame looks like: Phong for the frames that ship, metallic-roughness (glTF
// 2.0) for models that bring it. Colours are linear Rec.709.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "base/image.h"

namespace lorgnette {

using ImageRgba8 = Image<std::uint8_t, 4>;

// A picture laid over a surface. uv (0, 0) is its upper left corner, u runs right, v down, 1 is its
// whole width or height; beyond 0..1 it repeats, or its border goes on.
struct Texture {
  ImageRgba8 image;
  bool clamp_u = false, clamp_v = false;
};

// Surface of glTF 2.0. What a texture says is multiplied by the factor beside it.
struct PbrMaterial {
  Eigen::Vector3f base_color{1, 1, 1};
  float alpha = 1;            // coverage
  float metallic = 0;         // 0 dielectric, 1 metal
  float roughness = 1;        // square root of the GGX alpha
  float transmission = 0;     // share of the light that is not mirrored and passes through
  float ior = 1.5f;           // of the dielectric
  bool double_sided = false;  // its back is seen, too
  std::shared_ptr<const Texture> base_color_texture;  // sRGB-encoded, with coverage; null: none
  std::shared_ptr<const Texture> metallic_roughness_texture;  // plain: G roughness, B metal
  std::shared_ptr<const Texture> transmission_texture;        // plain: R
  std::shared_ptr<const Texture> normal_texture;              // plain: tangent space, 0.5 is 0
  float normal_scale = 1;                                     // of the normal texture's x and y
};

// Phong appearance (paper, V-A) is always there: for a model with `pbr`, its like with every
// texture at its mean. Renderers that know no more use it alone.
struct FrameMaterial {
  Eigen::Vector3f diffuse{0.02f, 0.02f, 0.02f};
  Eigen::Vector3f specular{0.04f, 0.04f, 0.04f};
  float shininess = 60;
  std::shared_ptr<const PbrMaterial> pbr;  // null: Phong is all there is
};

// Bilinear between texel centres, 0..1, as stored (R, G, B, A).
Eigen::Vector4f SampleTexture(const Texture& texture, const Eigen::Vector2f& uv);
// Colour and coverage of a texture in sRGB, interpolated in linear light.
Eigen::Vector4f SampleColor(const Texture& texture, const Eigen::Vector2f& uv);
// Mean colour of a texture in sRGB, linear.
Eigen::Vector3f MeanColor(const Texture& texture);

// The material at one point: the factors with their textures multiplied in.
struct PbrPoint {
  Eigen::Vector3f base_color;
  float alpha, metallic, roughness, transmission;
};
PbrPoint EvaluatePbr(const PbrMaterial& material, const Eigen::Vector2f& uv);

// Exponent of the Phong lobe that is as wide as GGX of a roughness: 2 / a^2 - 2, a = roughness^2.
float LobeExponent(float roughness);

// The Phong material that comes nearest: a dielectric mirrors ((ior - 1) / (ior + 1))^2, a metal
// its base colour; the lobe is as wide as that of roughness squared (exponent 2 / a^2 - 2).
FrameMaterial PhongLike(PbrMaterial material);

float LinearFromSrgb(float encoded);

}  // namespace lorgnette
