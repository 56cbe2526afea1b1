// SPDX-License-Identifier: Apache-2.0
#include "tracking/anchored_clip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"
#include "tracking/bundle.h"
#include "tracking/drift_limit.h"
#include "tracking/face_model.h"

namespace lorgnette {
namespace {

constexpr double kViewSpacing = RadiansFromDegrees(8);
constexpr double kViewReach = RadiansFromDegrees(12);  // weight of a view falls over this angle
constexpr std::size_t kMostViews = 12;
constexpr std::size_t kViewsPerFrame = 2;
constexpr std::size_t kKeyFrames = 24;
// Depth and focal length show in how the face changes as it turns. A face that hardly turns changes
// more by its expressions: then both keep near to what is usual.
constexpr double kFullParallax = RadiansFromDegrees(20);
constexpr double kDepthSigmaMm = 12, kLeastDepthSigmaMm = 1.5;
constexpr double kFirstSigma = 0.3, kLeastSigma = 0.15;  // of a sighting, crop px
// A key frame's errors are like those of others: they count as if this squared were one.
constexpr double kAlikeFrames = 4;
constexpr double kGoodWeight = 10;  // of the inliers of a pose that can be relied on
// Between two frames of a clip the landmarks' poses err by a few degrees; texture that says more
// was matched wrongly, or has drifted. On turning_512 ties that held were off by 4.7 degrees at
// most, one that misled by 8.6; fitted views differ from their landmarks by up to 3.7.
constexpr double kLandmarksDeny = RadiansFromDegrees(6), kMostDrift = RadiansFromDegrees(3);

struct Sighting {
  std::size_t view, anchor;
  Eigen::Vector2d pixel;
  double weight;
};

double AngleBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  // Only the turn out of the picture plane changes what a patch looks like.
  const double cosine = a.linear().col(2).dot(b.linear().col(2));
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

class Anchorer {
 public:
  Anchorer(const AnchoringInput& input, const Camera& camera) : in_(input), camera_(camera) {}

  void ChooseViews();
  // All frames against their nearest views.
  void MatchFrames();
  double Bundle(double focal_log_sigma);
  // Of the frames with sightings.
  std::vector<std::optional<PoseFit>> AllPoses() const;
  // Frames that look like none of the views (a grimace, a blur) are tied to their neighbours in
  // time, from both sides, and held near to what the landmarks say.
  void RepairPoses(AnchoredClip& clip) const;

  const Camera& camera() const { return camera_; }
  std::vector<AnchorView>& views() { return views_; }

 private:
  const Eigen::Isometry3d& Landmark(std::size_t f) const { return in_.landmark_poses[f]; }
  // A pixel of the frame's crop, in pixels of the frame.
  double CropPixel(std::size_t f) const {
    return in_.frames[f].crop.region.side / in_.frames[f].crop.width;
  }
  bool Seen(std::size_t f) const { return in_.frames[f].landmarks.has_value(); }
  // The views nearest to a frame, nearest first; `from` none.
  std::vector<std::size_t> NearestViews(std::size_t f) const;
  // The landmark pose, moved as the landmarks of the view were found to err.
  Eigen::Isometry3d Guess(std::size_t f, std::size_t view) const;
  std::vector<Sighting> Match(std::size_t f, Eigen::Isometry3d* pose) const;
  PoseFit Fit(const std::vector<Sighting>& sightings, const Eigen::Isometry3d& guess,
              double scale_px) const;
  // Between the first view and any frame.
  double GreatestTurn() const {
    double turn = 0;
    for (std::size_t f = 0; f < in_.frames.size(); ++f) {
      if (Seen(f)) turn = std::max(turn, AngleBetween(Landmark(views_[0].frame), Landmark(f)));
    }
    return turn;
  }
  void KeepSize();
  AnchorView ViewOf(std::size_t f, const Eigen::Isometry3d& pose) const;
  std::vector<std::optional<PoseFit>> Chain(const std::vector<std::optional<PoseFit>>& poses,
                                            std::size_t first, std::size_t last, int step) const;
  void AddView(std::size_t f, const Eigen::Isometry3d& pose);

  const AnchoringInput& in_;
  Camera camera_;
  std::vector<AnchorView> views_;
  std::vector<std::vector<Sighting>> sightings_;  // one a frame
  std::vector<Eigen::Isometry3d> guesses_;
};

std::vector<std::size_t> Anchorer::NearestViews(std::size_t f) const {
  std::vector<std::size_t> order(views_.size());
  for (std::size_t v = 0; v < order.size(); ++v) order[v] = v;
  const auto angle = [&](std::size_t v) {
    return AngleBetween(Landmark(f), Landmark(views_[v].frame));
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return angle(a) < angle(b); });
  // A view sees itself first, which ties it to nothing: two others, or in a fast turn, where every
  // frame is a view, those of one side lose their hold on those of the other.
  const bool is_view =
      std::any_of(views_.begin(), views_.end(), [f](const AnchorView& v) { return v.frame == f; });
  const std::size_t most = kViewsPerFrame + (is_view ? 1 : 0);
  if (order.size() > most) order.erase(order.begin() + std::ptrdiff_t(most), order.end());
  return order;
}

Eigen::Isometry3d Anchorer::Guess(std::size_t f, std::size_t view) const {
  const AnchorView& v = views_[view];
  return Moved(Landmark(f), MotionBetween(Landmark(v.frame), v.camera_from_head));
}

std::vector<Sighting> Anchorer::Match(std::size_t f, Eigen::Isometry3d* pose) const {
  const FaceCrop crop = in_.frames[f].crop.Load();
  const TexturePyramid texture(crop.grey);
  std::vector<Sighting> all;
  for (const std::size_t v : NearestViews(f)) {
    const bool first = all.empty();
    const auto match = MatchAnchors(views_[v], crop, texture, camera_, first ? Guess(f, v) : *pose,
                                    first ? PoseGuess::kRough : PoseGuess::kGood);
    if (!match) continue;
    if (first) *pose = match->pose.camera_from_head;
    const double off = AngleBetween(match->pose.camera_from_head, views_[v].camera_from_head);
    const double trust = std::exp(-0.5 * std::pow(off / kViewReach, 2));
    for (const AnchorSighting& s : match->sightings) {
      all.push_back({v, s.anchor, s.pixel, trust * s.weight});
    }
  }
  return all;
}

PoseFit Anchorer::Fit(const std::vector<Sighting>& sightings, const Eigen::Isometry3d& guess,
                      double scale_px) const {
  std::vector<PointSighting> points;
  points.reserve(sightings.size());
  for (const Sighting& s : sightings) {
    points.push_back({views_[s.view].anchors[s.anchor].head, s.pixel, s.weight});
  }
  return FitPose(camera_, points, guess, scale_px);
}

void Anchorer::AddView(std::size_t f, const Eigen::Isometry3d& pose) {
  views_.push_back(ViewOf(f, pose));
}

AnchorView Anchorer::ViewOf(std::size_t f, const Eigen::Isometry3d& pose) const {
  const FaceCrop crop = in_.frames[f].crop.Load();
  return MakeAnchorView(f, crop, TexturePyramid(crop.grey), camera_, pose, in_.face,
                        in_.rigid_weight);
}

void Anchorer::ChooseViews() {
  // Head on, seen along the line to the face.
  const auto off_axis = [&](std::size_t f) {
    const Eigen::Isometry3d& pose = Landmark(f);
    return std::acos(
        std::clamp(-pose.linear().col(2).dot(pose.translation().normalized()), -1.0, 1.0));
  };
  std::vector<std::size_t> seen;
  for (std::size_t f = 0; f < in_.frames.size(); ++f) {
    if (Seen(f)) seen.push_back(f);
  }
  LG_CHECK(!seen.empty());
  const std::size_t first =
      *std::min_element(seen.begin(), seen.end(),
                        [&](std::size_t a, std::size_t b) { return off_axis(a) < off_axis(b); });
  AddView(first, Landmark(first));
  // Then always the frame nearest to the views that is a step away from all of them, so that each
  // new view is tied to its neighbour.
  std::vector<std::size_t> candidates = seen;
  while (views_.size() < kMostViews) {
    const auto nearest = [&](std::size_t f) {
      double angle = kPi;
      for (const AnchorView& v : views_) {
        angle = std::min(angle, AngleBetween(Landmark(f), Landmark(v.frame)));
      }
      return angle;
    };
    std::size_t best = 0;
    double best_angle = kPi;
    for (const std::size_t f : candidates) {
      const double angle = nearest(f);
      if (angle >= kViewSpacing && angle < best_angle) {
        best = f;
        best_angle = angle;
      }
    }
    if (best_angle >= kPi) break;
    candidates.erase(std::find(candidates.begin(), candidates.end(), best));
    Eigen::Isometry3d pose;
    const std::vector<Sighting> tied = Match(best, &pose);
    if (tied.empty()) continue;
    const PoseFit fit = Fit(tied, pose, CropPixel(best));
    const Vector6d off = MotionBetween(Guess(best, tied.front().view), fit.camera_from_head);
    if (fit.inlier_weight < kGoodWeight || off.head<3>().norm() > kLandmarksDeny) continue;
    AddView(best, fit.camera_from_head);
  }
}

void Anchorer::MatchFrames() {
  sightings_.assign(in_.frames.size(), {});
  guesses_.assign(in_.frames.size(), Eigen::Isometry3d::Identity());
  tbb::parallel_for(std::size_t(0), in_.frames.size(), [this](std::size_t f) {
    if (Seen(f)) sightings_[f] = Match(f, &guesses_[f]);
  });
}

double Anchorer::Bundle(double focal_log_sigma) {
  // Key frames: the views and frames evenly spread over the clip.
  std::vector<std::size_t> keys;
  for (const AnchorView& view : views_) keys.push_back(view.frame);
  const std::vector<std::optional<PoseFit>> fits = AllPoses();
  std::vector<std::size_t> usable;
  for (std::size_t f = 0; f < fits.size(); ++f) {
    const bool is_view = std::find(keys.begin(), keys.end(), f) != keys.end();
    if (fits[f] && !is_view && fits[f]->inlier_weight >= kGoodWeight) usable.push_back(f);
  }
  const std::size_t stride = std::max<std::size_t>(1, usable.size() / kKeyFrames);
  for (std::size_t k = stride / 2; k < usable.size(); k += stride) keys.push_back(usable[k]);

  std::vector<BundlePoint> points;
  std::vector<std::size_t> first_point;
  for (const AnchorView& view : views_) {
    first_point.push_back(points.size());
    for (const TextureAnchor& a : view.anchors) points.push_back({a.head, a.ray, a.head});
  }
  std::vector<BundleSighting> sightings;
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const std::size_t f = keys[k];
    const bool is_view = k < views_.size();
    poses.push_back(is_view ? views_[k].camera_from_head : fits[f]->camera_from_head);
    if (is_view) {
      for (std::size_t a = 0; a < views_[k].anchors.size(); ++a) {
        const Eigen::Vector3d p = poses[k] * views_[k].anchors[a].head;
        sightings.push_back({k, first_point[k] + a, camera_.Project(p), 1});
      }
    }
    for (const Sighting& s : sightings_[f]) {
      if (is_view && s.view == k) continue;
      sightings.push_back({k, first_point[s.view] + s.anchor, s.pixel, s.weight});
    }
  }
  BundleOptions options;
  const double parallax = std::min(1.0, GreatestTurn() / kFullParallax);
  options.focal_log_sigma = parallax * focal_log_sigma;
  options.sigma_mm = std::max(kLeastDepthSigmaMm, parallax * parallax * kDepthSigmaMm);
  // What the rigid face leaves over (expressions, mostly) is alike in many frames: a first fit
  // tells how much it is, the second goes on from there and trusts the sightings no more than that
  // allows.
  const double crop_px = CropPixel(views_[0].frame);
  BundleReport report;
  options.sigma_px = kFirstSigma * crop_px;
  options.focal_prior_px = camera_.fx;
  report = FitBundle(sightings, options, camera_, poses, points);
  options.sigma_px = std::max(kLeastSigma * crop_px, kAlikeFrames * report.rms_px);
  report = FitBundle(sightings, options, camera_, poses, points);
  if (!report.usable) return 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    views_[v].camera_from_head = poses[v];
    for (std::size_t a = 0; a < views_[v].anchors.size(); ++a) {
      views_[v].anchors[a].head = points[first_point[v] + a].head;
    }
  }
  KeepSize();
  return report.rms_px;
}

// Pictures do not tell how large the head is: the bundle may have let it grow or shrink. Scales
// everything about the camera of the first view until its anchors lie, on average, on the mesh.
void Anchorer::KeepSize() {
  const Eigen::Vector3d centre = views_[0].camera_from_head.inverse().translation();
  double mesh = 0, found = 0;
  for (const TextureAnchor& a : views_[0].anchors) {
    mesh += (a.mesh - centre).dot(a.ray);
    found += (a.head - centre).dot(a.ray);
  }
  if (!(found > 0)) return;
  Similarity size;
  size.scale = mesh / found;
  size.shift = (1 - size.scale) * centre;
  for (AnchorView& view : views_) {
    view.camera_from_head = size.Rebased(view.camera_from_head);
    for (TextureAnchor& a : view.anchors) a.head = size(a.head);
  }
  for (Eigen::Isometry3d& guess : guesses_) guess = size.Rebased(guess);
}

std::vector<std::optional<PoseFit>> Anchorer::AllPoses() const {
  std::vector<std::optional<PoseFit>> poses(in_.frames.size());
  tbb::parallel_for(std::size_t(0), poses.size(), [&](std::size_t f) {
    if (!sightings_[f].empty()) poses[f] = Fit(sightings_[f], guesses_[f], CropPixel(f));
  });
  return poses;
}

// Follows frames first, first + step, ... up to last (left out) from the good frame before `first`.
std::vector<std::optional<PoseFit>> Anchorer::Chain(
    const std::vector<std::optional<PoseFit>>& poses, std::size_t first, std::size_t last,
    int step) const {
  std::vector<std::optional<PoseFit>> chained(in_.frames.size());
  std::size_t before = first - std::size_t(step);
  Eigen::Isometry3d pose = poses[before]->camera_from_head;
  AnchorView view = ViewOf(before, pose);
  for (std::size_t f = first; f != last; f += std::size_t(step)) {
    const FaceCrop crop = in_.frames[f].crop.Load();
    const TexturePyramid texture(crop.grey);
    for (const bool renewed : {false, true}) {
      if (renewed) {
        if (view.frame == before) break;
        view = ViewOf(before, pose);
      }
      const Eigen::Isometry3d guess = Moved(pose, MotionBetween(Landmark(before), Landmark(f)));
      const auto match = MatchAnchors(view, crop, texture, camera_, guess, PoseGuess::kRough);
      if (!match || match->pose.inlier_weight < kGoodWeight) continue;
      chained[f] = match->pose;
      break;
    }
    if (!chained[f]) break;
    pose = chained[f]->camera_from_head;
    before = f;
  }
  return chained;
}

void Anchorer::RepairPoses(AnchoredClip& clip) const {
  const std::vector<std::optional<PoseFit>> poses = clip.poses;
  const auto good = [&](std::size_t f) {
    return poses[f].has_value() && poses[f]->inlier_weight >= kGoodWeight;
  };
  const auto joined = [&](std::size_t f) {  // with the frame before
    return f > 0 && Seen(f) && Seen(f - 1) && !in_.frames[f].cut_before;
  };
  const std::size_t count = in_.frames.size();
  for (std::size_t a = 0; a < count;) {
    if (!Seen(a) || good(a)) {
      ++a;
      continue;
    }
    std::size_t b = a + 1;
    while (b < count && joined(b) && !good(b)) ++b;
    std::vector<std::optional<PoseFit>> forward(count), backward(count);
    const bool good_before = joined(a) && good(a - 1);
    const bool good_after = b < count && joined(b) && good(b);
    if (good_before) forward = Chain(poses, a, b, 1);
    if (good_after) backward = Chain(poses, b - 1, a - 1, -1);
    for (std::size_t f = a; f < b; ++f) {
      if (forward[f] && backward[f]) {
        // Each side drifts away from its own good frame.
        const double share = double(f + 1 - a) / double(b + 1 - a);
        const Vector6d apart =
            MotionBetween(forward[f]->camera_from_head, backward[f]->camera_from_head);
        clip.poses[f] = forward[f];
        clip.poses[f]->camera_from_head = Moved(forward[f]->camera_from_head, share * apart);
      } else if (forward[f] || backward[f]) {
        clip.poses[f] = forward[f] ? forward[f] : backward[f];
      }
    }
    LimitDrift(in_.landmark_poses, a, b, good_before, good_after, kMostDrift, clip.poses);
    a = b;
  }
}

}  // namespace

AnchoredClip AnchorClip(const AnchoringInput& input, double focal_log_sigma, Camera& camera) {
  Anchorer anchorer(input, camera);
  anchorer.ChooseViews();
  anchorer.MatchFrames();
  AnchoredClip clip;
  clip.rms_px = anchorer.Bundle(focal_log_sigma);
  clip.poses = anchorer.AllPoses();
  anchorer.RepairPoses(clip);
  camera = anchorer.camera();
  clip.views = std::move(anchorer.views());
  return clip;
}

}  // namespace lorgnette
