// SPDX-License-Identifier: Apache-2.0
// Strict reading of a JSON object: every key is asked for by type and range, an unknown key is an
// error, and errors read `file:key.path: got -4.2, want 0..180`.
//
//   LG_ASSIGN(JsonReader json, JsonReader::Parse(text, "rx.json"));
//   const double pd = json.Number("PD", 40, 80);
//   JsonReader od = json.Object("OD");  ...
//   LG_RETURN_IF_ERROR(json.Finish());   // first error of it or of any child, or an unknown key
//
// Getters never fail at once: after the first error they return harmless values and Finish reports.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"

namespace lorgnette {

class JsonReader {
 public:
  // Duplicate keys, NaN and a document that is not an object are errors.
  static Result<JsonReader> Parse(const std::string& text, const std::string& name);

  bool IsObject(const std::string& key) const;  // for keys that allow two forms; marks nothing
  bool Has(const std::string& key) const;  // present and not null; does not mark the key as read

  double Number(const std::string& key, double min, double max);
  double NumberOr(const std::string& key, double fallback, double min, double max);
  int IntegerOr(const std::string& key, int fallback, int min, int max);
  bool BoolOr(const std::string& key, bool fallback);
  std::string String(const std::string& key);
  std::string StringOr(const std::string& key, const std::string& fallback);
  std::vector<double> Numbers(const std::string& key);  // array of numbers, nested ones flattened
  JsonReader Object(const std::string& key);            // required; errors are shared with this
  std::vector<JsonReader> Objects(const std::string& key);  // array of objects
  std::vector<std::string> Keys() const;
  void Ignore(const std::string& key);  // known, and of no interest

  // Records an error about `key` of this object ("got ..., want ..."), for checks of the caller.
  void Fail(const std::string& key, const std::string& problem);
  Status Finish() const;

 private:
  struct Document;
  struct Node;
  explicit JsonReader(std::shared_ptr<Document> document, std::shared_ptr<Node> node);
  void FailMissing(const std::string& key, const std::string& want);
  std::shared_ptr<Document> document_;
  std::shared_ptr<Node> node_;
};

}  // namespace lorgnette
