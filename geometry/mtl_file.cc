// SPDX-License-Identifier: Apache-2.0
#include "geometry/mtl_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/atomic_file.h"
#include "geometry/text_line.h"
#include "geometry/texture_file.h"

namespace lorgnette {
namespace {

constexpr double kOpaque = 0.95;

class MtlParser {
 public:
  MtlParser(const std::string& name, const std::string& folder) : name_(name), folder_(folder) {}

  Status Line(std::string_view line, long number) {
    number_ = number;
    const std::string_view key = NextWord(line);
    if (key == "newmtl") {
      Close();
      current_ = std::string(RestOf(line));
      return {};
    }
    if (key == "Kd") return Colour(line, diffuse_);
    if (key == "Ks") return Colour(line, specular_);
    if (key == "Ns") return Number(line, shininess_);
    if (key == "d") return Number(line, opacity_);
    if (key == "Tr") {
      LG_RETURN_IF_ERROR(Number(line, opacity_));
      opacity_ = 1 - opacity_;
      return {};
    }
    if (key == "Ni") return Number(line, index_);
    if (key == "Pm") return Number(line, metallic_);
    if (key == "Pr") return Number(line, roughness_);
    if (key == "map_Kd") Picture(line);
    return {};
  }
  MtlFile Finish() {
    Close();
    return std::move(file_);
  }

 private:
  Status Number(std::string_view line, double& to) const {
    std::string_view word = NextWord(line);
    if (word == "-halo") word = NextWord(line);
    if (!ReadDouble(word, to) || !std::isfinite(to)) {
      return Failure(name_ + ":" + std::to_string(number_) + ": got \"" + std::string(word) +
                     "\", want a number");
    }
    return {};
  }
  Status Colour(std::string_view line, Eigen::Vector3f& to) const {
    Eigen::Vector3d rgb(0, 0, 0);
    std::string_view rest = line;
    const std::string_view first = NextWord(rest);
    if (first == "spectral" || first == "xyz") return {};  // rare: the default stays
    for (int k = 0; k < 3; ++k) {
      if (k == 1 && RestOf(line).empty()) {  // one number stands for all three
        rgb.setConstant(rgb[0]);
        break;
      }
      const std::string_view word = NextWord(line);
      if (!ReadDouble(word, rgb[k]) || !std::isfinite(rgb[k])) {
        return Failure(name_ + ":" + std::to_string(number_) + ": got \"" + std::string(word) +
                       "\", want a number");
      }
    }
    to = rgb.cwiseMax(0).cwiseMin(1).cast<float>();
    return {};
  }
  // Options come before the name, each with its own number of values.
  void Picture(std::string_view line) {
    if (folder_.empty()) return;
    std::string_view rest = line;
    for (std::string_view word = NextWord(rest); word.starts_with('-'); word = NextWord(rest)) {
      if (word == "-clamp") {
        clamp_ = NextWord(rest) == "on";
      } else if (word == "-mm") {
        NextWord(rest);
        NextWord(rest);
      } else if (word == "-o" || word == "-s" || word == "-t") {  // up to three numbers
        double value = 0;
        for (int k = 0; k < 3; ++k) {
          std::string_view ahead = rest;
          if (!ReadDouble(NextWord(ahead), value)) break;
          rest = ahead;
        }
      } else {
        NextWord(rest);
      }
      line = rest;
    }
    std::string picture(RestOf(line));
    std::replace(picture.begin(), picture.end(), '\\', '/');
    const std::string path = (std::filesystem::path(folder_) / picture).string();
    const Result<std::string> bytes = ReadFile(path);
    Result<Texture> texture = bytes ? DecodeTexture(*bytes, path) : tl::unexpected(bytes.error());
    if (!texture) {
      file_.notes.push_back("picture left out: " + texture.error().message);
      return;
    }
    texture->clamp_u = texture->clamp_v = clamp_;
    // v runs upwards in OBJ and was turned there; pictures repeat alike both ways.
    texture_ = std::make_shared<const Texture>(std::move(*texture));
  }

  void Close() {
    if (!current_.empty()) {
      PbrMaterial pbr;
      pbr.base_color = diffuse_;
      pbr.alpha = float(std::clamp(opacity_, 0.0, 1.0));
      pbr.ior = float(std::clamp(index_, 1.0, 4.0));
      pbr.metallic = float(std::clamp(metallic_, 0.0, 1.0));
      // A Phong lobe of exponent Ns is as wide as that of alpha^2 = 2 / (Ns + 2).
      pbr.roughness = float(std::clamp(
          roughness_ >= 0 ? roughness_ : std::pow(2 / (std::max(shininess_, 0.0) + 2), 0.25), 0.0,
          1.0));
      pbr.base_color_texture = texture_;
      MtlMaterial material;
      material.transparent = opacity_ < kOpaque;
      material.surface = PhongLike(std::move(pbr));
      if (metallic_ <= 0 && roughness_ < 0) {  // a Phong material: as it is written
        material.surface.specular = specular_;
        material.surface.shininess = float(std::clamp(shininess_, 1.0, 1000.0));
      }
      file_.materials[current_] = std::move(material);
    }
    diffuse_.setConstant(0.6f);
    specular_.setConstant(0.04f);
    shininess_ = 60;
    opacity_ = 1;
    index_ = 1.5;
    metallic_ = 0;
    roughness_ = -1;
    texture_ = nullptr;
    clamp_ = false;
  }

  std::string name_, folder_, current_;
  MtlFile file_;
  long number_ = 0;
  Eigen::Vector3f diffuse_{0.6f, 0.6f, 0.6f}, specular_{0.04f, 0.04f, 0.04f};
  double shininess_ = 60, opacity_ = 1, index_ = 1.5, metallic_ = 0, roughness_ = -1;  // -1: by Ns
  std::shared_ptr<const Texture> texture_;
  bool clamp_ = false;
};

}  // namespace

Result<MtlFile> ParseMtl(std::string_view text, const std::string& name,
                         const std::string& folder) {
  MtlParser parser(name, folder);
  long number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    LG_RETURN_IF_ERROR(parser.Line(text.substr(0, end), ++number));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parser.Finish();
}

}  // namespace lorgnette
