// SPDX-License-Identifier: Apache-2.0
// Runs the program in this process, in a folder of its own.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "apps/program.h"
#include "base/atomic_file.h"
#include "cmake/source_dir.h"

namespace lorgnette {

inline constexpr char kTable1[] = LORGNETTE_SOURCE_DIR "/data/prescriptions/table1.json";

struct Ran {
  int code = 0;
  std::string out, err;
  nlohmann::json Json() const { return nlohmann::json::parse(out); }
};

class ProgramTest : public testing::Test {
 protected:
  ProgramTest() {
    std::string pattern = testing::TempDir() + "lorgnette_program_XXXXXX";
    folder_ = mkdtemp(pattern.data());
  }
  ~ProgramTest() override { std::filesystem::remove_all(folder_); }

  static Ran Run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "lorgnette");
    std::vector<const char*> argv;
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    std::ostringstream out, err;
    Ran ran;
    ran.code = RunProgram(static_cast<int>(argv.size()), argv.data(), out, err);
    ran.out = out.str();
    ran.err = err.str();
    return ran;
  }

  std::string Path(const std::string& name) const { return folder_ + "/" + name; }
  std::string Write(const std::string& name, const std::string& content) const {
    EXPECT_TRUE(WriteFileAtomically(Path(name), content));
    return Path(name);
  }
  std::vector<std::string> FilesHere() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  // One line that starts with the program's name and holds no newline before its end.
  static void ExpectOneSentence(const std::string& err) {
    EXPECT_THAT(err, testing::StartsWith("lorgnette"));
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    EXPECT_EQ(err.back(), '\n');
  }

  std::string folder_;
};

inline std::string SharedData(const std::string& name) {
  return LORGNETTE_SOURCE_DIR "/../shared/data/" + name;
}
inline bool HasModels() {
  return std::filesystem::exists(LORGNETTE_SOURCE_DIR "/cache/models/face_landmark.onnx");
}

}  // namespace lorgnette
