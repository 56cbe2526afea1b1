// SPDX-License-Identifier: Apache-2.0
// Materials of model files: what glTF and MTL say arrives, textures and all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/atomic_file.h"
#include "geometry/frame_material.h"
#include "geometry/model_file.h"
#include "geometry/mtl_file.h"
#include "geometry/texture_file.h"

namespace lorgnette {
namespace {

// A triangle below two nodes, with a picture of a red and a green pixel.
constexpr const char* kTexturedGltf = R"({"asset":{"version":"2.0"},"scene":0,
"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1],"translation":[0,0,2]},{"mesh":0,"name":"shell","scale":[2,2,2]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,
"material":0}]}],
"materials":[{"name":"amber","pbrMetallicRoughness":{"baseColorFactor":[1,0.5,1,1],
"metallicFactor":0.25,"roughnessFactor":0.5,"baseColorTexture":{"index":0}},
"extensions":{"KHR_materials_transmission":{"transmissionFactor":0.8},
"KHR_materials_ior":{"ior":1.46}}}],
"textures":[{"source":0}],
"images":[{"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR4nGP4z8DA8J8BAAf/Af8Bf4mnAAAAAElFTkSuQmCC"}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},
{"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
{"buffer":0,"byteOffset":60,"byteLength":6}],
"buffers":[{"byteLength":66,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAACAPgAAAD8AAEA/AAAAPwAAgD4AAAA/AAABAAIA"}]})";

TEST(ParseGltf, KeepsNodesUvsMaterialAndTexture) {
  const auto model = ParseGltf(kTexturedGltf, "amber.gltf", "");
  ASSERT_TRUE(model.has_value()) << model.error().message;
  ASSERT_EQ(model->parts.size(), 1u);
  const ModelPart& part = model->parts[0];
  EXPECT_EQ(part.name, "shell amber");
  EXPECT_TRUE(part.transparent);
  EXPECT_EQ(model->mm_per_unit, 1000);
  ASSERT_EQ(part.mesh.positions.size(), 3u);
  EXPECT_EQ(part.mesh.positions[1], Eigen::Vector3d(2, 0, 2));  // scaled, then lifted
  ASSERT_EQ(part.mesh.uvs.size(), 3u);
  ASSERT_NE(part.material.pbr, nullptr);
  const PbrMaterial& pbr = *part.material.pbr;
  EXPECT_FLOAT_EQ(pbr.metallic, 0.25f);
  EXPECT_FLOAT_EQ(pbr.roughness, 0.5f);
  EXPECT_FLOAT_EQ(pbr.transmission, 0.8f);
  EXPECT_FLOAT_EQ(pbr.ior, 1.46f);
  ASSERT_NE(pbr.base_color_texture, nullptr);
  EXPECT_EQ(pbr.base_color_texture->image.width, 2);
  // The first vertex looks at the middle of the red pixel, the second at that of the green one.
  const PbrPoint red = EvaluatePbr(pbr, part.mesh.uvs[0]);
  const PbrPoint green = EvaluatePbr(pbr, part.mesh.uvs[1]);
  EXPECT_TRUE(red.base_color.isApprox(Eigen::Vector3f(1, 0, 0)));
  EXPECT_TRUE(green.base_color.isApprox(Eigen::Vector3f(0, 0.5f, 0)));
  // Phong has the mean of both: a quarter of the dielectric's share is metal.
  EXPECT_NEAR(part.material.diffuse.x(), 0.5 * (0.75 + 0.25 * 0.25), 1e-6);
}

TEST(SampleTexture, InterpolatesWrapsAndClamps) {
  Texture texture;
  texture.image = ImageRgba8(2, 1);
  texture.image.data = {0, 0, 0, 255, 255, 255, 255, 255};
  EXPECT_FLOAT_EQ(SampleTexture(texture, {0.25f, 0.5f}).x(), 0);
  EXPECT_FLOAT_EQ(SampleTexture(texture, {0.5f, 0.5f}).x(), 0.5f);
  EXPECT_FLOAT_EQ(SampleTexture(texture, {0.0f, 0.5f}).x(), 0.5f);  // its neighbour is the last
  EXPECT_FLOAT_EQ(SampleTexture(texture, {-0.75f, 7.5f}).x(), 0);   // as at 0.25
  EXPECT_FLOAT_EQ(SampleTexture(texture, {1.75f, -0.5f}).x(), 1);   // as at 0.75
  texture.clamp_u = true;
  EXPECT_FLOAT_EQ(SampleTexture(texture, {-3, 0.5f}).x(), 0);
  EXPECT_FLOAT_EQ(SampleTexture(texture, {3, 0.5f}).x(), 1);
  EXPECT_EQ(SampleTexture(Texture{}, {0, 0}), Eigen::Vector4f::Ones());
}

TEST(ParseMtl, ReadsPhongAndMetallicMaterials) {
  const auto file = ParseMtl(
      "newmtl black lacquer\nKd 0.1 0.2 0.3\nKs 0.5\nNs 200\nnewmtl steel\nKd 0.6 0.6 0.6\nPm 1\n"
      "Pr 0.25\nnewmtl demo\nd 0.2\nmap_Kd -s 2 2 1 -clamp on missing.png\n",
      "a.mtl", "");
  ASSERT_TRUE(file.has_value()) << file.error().message;
  ASSERT_EQ(file->materials.size(), 3u);
  const FrameMaterial& lacquer = file->materials.at("black lacquer").surface;
  EXPECT_TRUE(lacquer.diffuse.isApprox(Eigen::Vector3f(0.1f, 0.2f, 0.3f)));
  EXPECT_TRUE(lacquer.specular.isApprox(Eigen::Vector3f(0.5f, 0.5f, 0.5f)));
  EXPECT_FLOAT_EQ(lacquer.shininess, 200);
  EXPECT_FALSE(file->materials.at("black lacquer").transparent);
  EXPECT_FLOAT_EQ(file->materials.at("steel").surface.pbr->metallic, 1);
  EXPECT_FLOAT_EQ(file->materials.at("steel").surface.pbr->roughness, 0.25f);
  EXPECT_TRUE(file->materials.at("demo").transparent);
  const auto bad = ParseMtl("newmtl a\nKd red\n", "a.mtl", "");
  ASSERT_FALSE(bad.has_value());
  EXPECT_THAT(bad.error().message, testing::HasSubstr("a.mtl:2"));
}

TEST(ParseObj, TakesMaterialsUvsAndTellsWhatIsMissing) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "lorgnette_obj_with_mtl";
  std::filesystem::create_directories(folder);
  ASSERT_TRUE(WriteFileAtomically((folder / "m.mtl").string(),
                                  "newmtl gold\nKd 0.9 0.6 0.2\nPm 1\nmap_Kd none.png\n"));
  const std::string text =
      "mtllib m.mtl\nmtllib absent.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nvt 1 1\n"
      "o ring\nusemtl gold\nf 1/1 2/2 3/1\n";
  const auto model = ParseObj(text, "ring.obj", folder.string());
  ASSERT_TRUE(model.has_value()) << model.error().message;
  ASSERT_EQ(model->parts.size(), 1u);
  EXPECT_EQ(model->parts[0].name, "ring gold");
  ASSERT_NE(model->parts[0].material.pbr, nullptr);
  EXPECT_FLOAT_EQ(model->parts[0].material.pbr->metallic, 1);
  ASSERT_EQ(model->parts[0].mesh.uvs.size(), 3u);
  EXPECT_EQ(model->parts[0].mesh.uvs[0], Eigen::Vector2f(0, 0.75f));  // v runs downwards here
  EXPECT_THAT(model->notes,
              testing::UnorderedElementsAre(testing::HasSubstr("picture left out"),
                                            testing::HasSubstr("materials left out")));
}

// Eleven million pixels a line, in a hundred bytes: refused before there is memory for them.
TEST(Texture, APngOfTooManyPixelsIsRefused) {
  const char bytes[] = "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\xab\0\4\0\0\0\4\x10\0\0\0\0\0\0\0\0";
  const std::string_view picture(bytes, sizeof bytes - 1);
  EXPECT_FALSE(PictureFits(picture));
  const auto refused = DecodeTexture(picture, "a.png");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("8192"));
}

TEST(Texture, AChunkLongerThanItsFileIsRefused) {
  // A header, and a data chunk that states 1.9 GB.
  const char bytes[] =
      "\x89PNG\r\n\x1a\n"
      "\0\0\0\x0dIHDR\0\0\0\x10\0\0\0\x08\x08\x02\0\0\0\x7f\x14\xe8\xc0"
      "\x72\0\0\x50IDAT\xf1\0\xed\xf3";
  const auto refused = DecodeTexture(std::string_view(bytes, sizeof bytes - 1), "a.png");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message.rfind("a.png: got no picture", 0), 0u);
}

}  // namespace
}  // namespace lorgnette
