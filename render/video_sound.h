// SPDX-License-Identifier: Apache-2.0
// Copies the sound streams of a source into an output, packet by packet, undecoded. Private.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/video_av.h"

namespace lorgnette {

class SoundCopier {
 public:
  // Adds one stream to `output` for each sound stream of the file; nullptr when it has none.
  static Result<std::unique_ptr<SoundCopier>> Open(const std::string& source,
                                                   AVFormatContext* output,
                                                   const std::string& output_name);

  // Sound before `begin_s` is left out, and all time stamps are moved by -begin_s.
  void StartAt(double begin_s) { begin_s_ = begin_s; }
  // Writes the packets that start before `end_s` (source time) and have not been written yet.
  // Returns libav's error code, 0 if none.
  int CopyUntil(double end_s);

 private:
  SoundCopier(av::Input input, AVFormatContext* output);
  int ReadNext();  // fills packet_ with the next one of a sound stream
  av::Input input_;
  AVFormatContext* output_;
  av::Packet packet_;
  bool pending_ = false, ended_ = false;
  double begin_s_ = 0;
  std::vector<int> stream_map_;  // source stream to output stream, -1: not copied
};

}  // namespace lorgnette
