// SPDX-License-Identifier: Apache-2.0
#include "validation/ground_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "cmake/source_dir.h"
#include "render/color.h"
#include "render/image_io.h"

namespace lorgnette::validation {
namespace {

namespace fs = std::filesystem;

constexpr double kEyeDisc_mm = 9;      // about each pupil
constexpr double kShadowLeast = 0.02;  // change of the skin that counts as shadow
constexpr int kShadowWindow = 4;       // half of 9 x 9 pixels
const Eigen::Vector3d kPupils[] = {{-32, 0, 0}, {32, 0, 0}};

int CodeAt(const ImageRgbaF& hits, int x, int y) { return int(std::lround(hits.at(x, y)[3])); }

// Sums of a row-major field over windows, by prefix sums.
class Windows {
 public:
  template <typename F>
  Windows(int width, int height, F&& value) : width_(width), height_(height) {
    sums_.assign(std::size_t(width + 1) * std::size_t(height + 1), 0.0);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        At(x + 1, y + 1) = value(x, y) + At(x, y + 1) + At(x + 1, y) - At(x, y);
      }
    }
  }
  double Around(int x, int y) const {
    const int x0 = std::max(0, x - kShadowWindow), x1 = std::min(width_, x + kShadowWindow + 1);
    const int y0 = std::max(0, y - kShadowWindow), y1 = std::min(height_, y + kShadowWindow + 1);
    return At(x1, y1) - At(x0, y1) - At(x1, y0) + At(x0, y0);
  }

 private:
  double& At(int x, int y) {
    return sums_[std::size_t(y) * std::size_t(width_ + 1) + std::size_t(x)];
  }
  double At(int x, int y) const {
    return sums_[std::size_t(y) * std::size_t(width_ + 1) + std::size_t(x)];
  }
  int width_, height_;
  std::vector<double> sums_;
};

double Sum(const float* p) { return double(p[0]) + double(p[1]) + double(p[2]); }

// Which pixels of the crop belong to the region.
std::vector<bool> Mask(const GroundTruth& truth, Region region) {
  const int w = truth.hits.width, h = truth.hits.height;
  std::vector<bool> mask(std::size_t(w) * std::size_t(h), false);
  const auto skin = [&](int x, int y) { return CodeAt(truth.hits, x, y) == int(HitCode::kHead); };
  const Windows with(w, h,
                     [&](int x, int y) { return skin(x, y) ? Sum(truth.frame_only.at(x, y)) : 0; });
  const Windows without(w, h, [&](int x, int y) {
    return skin(x, y) ? Sum(truth.scene.input.at(x + truth.x0, y + truth.y0)) : 0;
  });
  const Windows share(w, h, [&](int x, int y) { return skin(x, y) ? 1.0 : 0.0; });
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const int code = CodeAt(truth.hits, x, y);
      const bool through = code == 1 || code == 2;
      bool in = false;
      if (region == Region::kLens) in = through || code == 3;
      if (region == Region::kEyes && through) {
        const float* p = truth.hits.at(x, y);
        for (const Eigen::Vector3d& pupil : kPupils) {
          in = in || (Eigen::Vector3d(double(p[0]), double(p[1]), double(p[2])) - pupil).norm() <
                         kEyeDisc_mm;
        }
      }
      if (region == Region::kShadow && skin(x, y)) {
        const double ratio = with.Around(x, y) / std::max(1e-9, without.Around(x, y));
        constexpr double kWindow = (2 * kShadowWindow + 1) * (2 * kShadowWindow + 1);
        in = std::abs(ratio - 1) > kShadowLeast && share.Around(x, y) > kWindow / 2;
      }
      mask[std::size_t(y) * std::size_t(w) + std::size_t(x)] = in;
    }
  }
  return mask;
}

double Encoded(float linear) { return SrgbFromLinear(std::clamp(double(linear), 0.0, 1.0)); }

}  // namespace

std::string GroundTruthFolder() {
  const char* own = std::getenv("LORGNETTE_GROUNDTRUTH");
  return own != nullptr ? own : LORGNETTE_SOURCE_DIR "/../shared/data/groundtruth";
}

std::string OwnGroundTruthFolder() { return LORGNETTE_SOURCE_DIR "/cache/groundtruth"; }

Result<GroundTruth> ReadGroundTruth(const std::string& case_file) {
  LG_ASSIGN(ComposeCase scene, ReadComposeCase(case_file));
  GroundTruth truth{std::move(scene), 0, 0, {}, {}, {}, 0, 0, 0};
  LG_ASSIGN(const std::string text, ReadFile(case_file));
  const fs::path folder = fs::path(case_file).parent_path();
  try {
    const auto json = nlohmann::json::parse(text);
    const auto crop = json.at("image").at("crop_x0_y0_w_h");
    truth.x0 = crop.at(0);
    truth.y0 = crop.at(1);
    const auto& files = json.at("files");
    const auto path = [&](const char* key) {
      return (folder / files.at(key).get<std::string>()).string();
    };
    LG_ASSIGN(truth.truth, ReadExr(path("full_nocaustic")));
    LG_ASSIGN(truth.frame_only, ReadExr(path("frame_only")));
    LG_ASSIGN(truth.hits, ReadExrRgba(path("hit")));
    const auto rms = [&](const char* file, const char* region) {
      return json.at("noise").at(file).at(region).at("rms_linear").get<double>();
    };
    truth.noise_lens = rms("full_nocaustic", "lens_on_head");
    truth.noise_skin = rms("full_nocaustic", "skin_direct");
    truth.noise_input = rms("input", "lens_on_head");
  } catch (const nlohmann::json::exception& error) {
    return Failure(fmt::format("{}: {}", case_file, error.what()));
  }
  return truth;
}

RegionScore ScoreRegion(const GroundTruth& truth, const ImageRgbF& picture, Region region) {
  const std::vector<bool> mask = Mask(truth, region);
  const int w = truth.hits.width;
  RegionScore score;
  double encoded = 0, signed_sum = 0, truth_sum = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i]) continue;
    const int x = int(i) % w, y = int(i) / w;
    const float* wanted = truth.truth.at(x, y);
    const float* found = picture.at(x + truth.x0, y + truth.y0);
    ++score.pixels;
    for (int c = 0; c < 3; ++c) {
      const double d = double(found[c]) - double(wanted[c]);
      score.mean_square += d * d;
      signed_sum += d;
      truth_sum += double(wanted[c]);
      encoded += std::pow(Encoded(found[c]) - Encoded(wanted[c]), 2);
    }
  }
  const double n = 3 * double(std::max(1L, score.pixels));
  score.mean_square /= n;
  score.bias = truth_sum > 0 ? signed_sum / truth_sum : 0;
  score.psnr_db = -10 * std::log10(std::max(encoded / n, 1e-12));
  const double own = region == Region::kShadow ? truth.noise_skin : truth.noise_lens;
  score.noise_square = own * own + truth.noise_input * truth.noise_input;
  return score;
}

void CheckGroundTruth(CaseRun& run, const std::string& name, const std::string& folder) {
  const std::string file = folder + "/" + name + "/case.json";
  std::error_code ec;
  if (!fs::exists(file, ec)) {
    run.Skip(folder == OwnGroundTruthFolder()
                 ? "no " + name + " on this machine; scripts/make-groundtruth makes it"
                 : "no path-traced set " + name + " on this machine ($LORGNETTE_GROUNDTRUTH)");
    return;
  }
  auto truth = ReadGroundTruth(file);
  const auto broken = [&](const Error& error) {
    run.Bound(error.message, "1", 1, 0, "the set can be read and rendered");
  };
  if (!truth) return broken(truth.error());
  const auto render = [&](const std::function<void(CompositorOptions&)>& change,
                          ImageRgbaF* hits) -> Result<ImageRgbF> {
    CompositorOptions options = truth->scene.options;
    options.samples_per_side = 2;
    change(options);
    LG_ASSIGN(const Compositor compositor,
              Compositor::Create(truth->scene.eyewear, truth->scene.head, TriangleMesh{},
                                 truth->scene.environment, options));
    if (hits != nullptr) {
      *hits = compositor.HitMap(truth->scene.camera, truth->scene.camera_from_head);
    }
    return compositor.Render(truth->scene.input, truth->scene.camera,
                             truth->scene.camera_from_head);
  };
  ImageRgbaF hits;
  const auto picture = render([](CompositorOptions&) {}, &hits);
  if (!picture) return broken(picture.error());

  // Where the rays through the pixels' centres meet the head.
  double sum_px = 0;
  long compared = 0, differing = 0;
  for (int y = 0; y < truth->hits.height; ++y) {
    for (int x = 0; x < truth->hits.width; ++x) {
      const float* wanted = truth->hits.at(x, y);
      const float* found = hits.at(x + truth->x0, y + truth->y0);
      const int code = CodeAt(truth->hits, x, y);
      if (code != 1 && code != 2) continue;
      if (int(std::lround(found[3])) != code) {
        ++differing;
        continue;
      }
      const auto px = [&](const float* p) -> Eigen::Vector2d {
        return truth->scene.camera.Project(
            truth->scene.camera_from_head *
            Eigen::Vector3d(double(p[0]), double(p[1]), double(p[2])));
      };
      sum_px += (px(found) - px(wanted)).norm();
      ++compared;
    }
  }
  run.Bound("refracted rays, mean distance of their hits", "px",
            compared > 0 ? sum_px / double(compared) : 1e9, 0.02, "asked");
  run.Bound("pixels whose ray meets another thing, share", "1",
            double(differing) / double(std::max(1L, compared)), 2e-3,
            "silhouettes, where the last digit decides");

  // Mean squares against what the noise of both pictures gives by itself.
  struct Wanted {
    Region region;
    const char* name;
    double noise_multiple;  // asked
    const char* effect;     // whose absence has to score worse here
    void (*leave_out)(CompositorOptions&);
  };
  const Wanted kWanted[] = {
      {Region::kEyes, "eyes", 4, "refraction",
       [](CompositorOptions& o) { o.effects.Set(Effect::kRefraction, false); }},
      {Region::kLens, "lens", 0, "reflection",
       [](CompositorOptions& o) {
         for (const Effect effect : {Effect::kFrontReflection, Effect::kBackReflection,
                                     Effect::kRings, Effect::kBounces}) {
           o.effects.Set(effect, false);
         }
       }},
      {Region::kShadow, "shadow", 2, "shadow",
       [](CompositorOptions& o) { o.shadow = ShadowMode::kNone; }}};
  for (const Wanted& wanted : kWanted) {
    const RegionScore score = ScoreRegion(*truth, *picture, wanted.region);
    const std::string where =
        fmt::format("{} ({} pixels, {:.2f} dB): ", wanted.name, score.pixels, score.psnr_db);
    if (wanted.noise_multiple > 0) {
      run.Bound(where + "mean square over that of the noise", "1",
                score.mean_square / score.noise_square, wanted.noise_multiple,
                "1 is noise alone; the input's pixels are resampled, and the model is not physics");
    }
    const bool background = wanted.region == Region::kLens;
    run.Bound(where + "mean error over the mean light", "1", score.bias, background ? 0.02 : 0.01,
              background ? "a lens shows background that the input picture does not"
                         : "a per cent of the light");
    const auto without = render(wanted.leave_out, nullptr);
    if (!without) return broken(without.error());
    const RegionScore worse = ScoreRegion(*truth, *without, wanted.region);
    run.Bound(
        fmt::format("{}: mean square as a share of that without {}", wanted.name, wanted.effect),
        "1", score.mean_square / worse.mean_square, 0.9, "each effect has to pay");
  }
}

}  // namespace lorgnette::validation
