// SPDX-License-Identifier: Apache-2.0
#include "base/json_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

namespace lorgnette {
namespace {

using Json = nlohmann::json;

constexpr int kMaxDepth = 32;
constexpr std::size_t kMaxQuoted = 40;  // longest string that an error repeats in full

std::string Shortened(std::string text) {
  if (text.size() > kMaxQuoted) text = text.substr(0, kMaxQuoted) + "...";
  return text;
}

// A key as an error shows it: on one line, whatever is in it.
std::string ShownKey(const std::string& key) {
  const std::string quoted = Json(key).dump(-1, ' ', true, Json::error_handler_t::replace);
  return Shortened(quoted.substr(1, quoted.size() - 2));
}

// The value as an error shows it: scalars as written, containers by kind.
std::string Shown(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  return Shortened(value.dump(-1, ' ', true, Json::error_handler_t::replace));
}

std::string WantedRange(const char* what, double min, double max) {
  const bool low = std::isfinite(min);
  const bool high = std::isfinite(max);
  if (low && high) return fmt::format("{}..{}", min, max);
  if (low) return fmt::format("{} of at least {}", what, min);
  if (high) return fmt::format("{} of at most {}", what, max);
  return what;
}

// A value that no later arithmetic trips over.
double Harmless(double min, double max) { return std::min(std::max(0.0, min), max); }

// Watches a parse for what the library lets pass: repeated keys and absurd nesting.
class ParseWatch {
 public:
  bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
    if (depth > kMaxDepth && problem_.empty()) {
      problem_ = fmt::format(" nested deeper than {} levels", kMaxDepth);
    }
    switch (event) {
      case Json::parse_event_t::object_start:
        open_.emplace_back();
        break;
      case Json::parse_event_t::object_end:
        open_.pop_back();
        break;
      case Json::parse_event_t::key:
        open_.back().current = parsed.get<std::string>();
        if (!open_.back().seen.insert(open_.back().current).second && problem_.empty()) {
          problem_ = Path() + ": given twice, want it once";
        }
        break;
      default:
        break;
    }
    return true;
  }
  const std::string& problem() const { return problem_; }

 private:
  struct OpenObject {
    std::string current;
    std::set<std::string> seen;
  };
  std::string Path() const {
    std::string path;
    for (const OpenObject& object : open_) {
      path += (path.empty() ? "" : ".") + ShownKey(object.current);
    }
    return path;
  }
  std::vector<OpenObject> open_;
  std::string problem_;
};

// "line 3, column 14: unexpected ..." out of the library's sentence.
std::string Plain(const std::string& what) {
  const std::size_t at = what.find("line ");
  const std::size_t bracket = what.find("] ");
  if (at != std::string::npos) return what.substr(at);
  return bracket == std::string::npos ? what : what.substr(bracket + 2);
}

bool Flatten(const Json& value, std::vector<double>& out) {
  if (value.is_number()) {
    out.push_back(value.get<double>());
    return true;
  }
  return value.is_array() && std::all_of(value.begin(), value.end(),
                                         [&](const Json& item) { return Flatten(item, out); });
}

}  // namespace

struct JsonReader::Document {
  std::string name;
  Json root;
  std::optional<std::string> first_error;
  bool first_error_is_a_missing_key = false;
};

struct JsonReader::Node {
  const Json* value;  // an object of the document; null after an error: every key is missing
  std::string path;
  std::vector<std::string> asked;
  std::vector<std::shared_ptr<Node>> children;

  std::string PathOf(const std::string& key) const {
    if (path.empty() || key.empty()) return path + ShownKey(key);
    return path + "." + ShownKey(key);
  }
  void MarkAsked(const std::string& key) {
    if (std::find(asked.begin(), asked.end(), key) == asked.end()) asked.push_back(key);
  }
  // The value under `key`, which counts as asked for from now on; null when absent.
  const Json* Ask(const std::string& key) {
    MarkAsked(key);
    if (value == nullptr) return nullptr;
    const auto it = value->find(key);
    return it == value->end() || it->is_null() ? nullptr : &*it;
  }
  // "path.key: unknown key, want ..." for the first unknown key of it and its children.
  std::optional<std::string> UnknownKey() const {
    if (value != nullptr) {
      for (const auto& [key, ignored] : value->items()) {
        if (std::find(asked.begin(), asked.end(), key) != asked.end()) continue;
        return fmt::format("{}: unknown key, want {}", PathOf(key),
                           asked.empty() ? "none here" : fmt::format("{}", fmt::join(asked, ", ")));
      }
    }
    for (const auto& child : children) {
      if (auto unknown = child->UnknownKey()) return unknown;
    }
    return std::nullopt;
  }
};

JsonReader::JsonReader(std::shared_ptr<Document> document, std::shared_ptr<Node> node)
    : document_(std::move(document)), node_(std::move(node)) {}

Result<JsonReader> JsonReader::Parse(const std::string& text, const std::string& name) {
  auto document = std::make_shared<Document>();
  document->name = name;
  ParseWatch watch;
  try {
    document->root =
        Json::parse(text, [&watch](int depth, Json::parse_event_t event, Json& parsed) {
          return watch(depth, event, parsed);
        });
  } catch (const Json::exception& e) {
    return UsageError(fmt::format("{}: not JSON: {}", name, Plain(e.what())));
  }
  if (!watch.problem().empty()) return UsageError(name + ":" + watch.problem());
  if (!document->root.is_object()) {
    return UsageError(fmt::format("{}: got {}, want an object", name, Shown(document->root)));
  }
  auto node = std::make_shared<Node>();
  node->value = &document->root;
  return JsonReader(std::move(document), std::move(node));
}

bool JsonReader::Has(const std::string& key) const {
  if (node_->value == nullptr) return false;
  const auto it = node_->value->find(key);
  return it != node_->value->end() && !it->is_null();
}

bool JsonReader::IsObject(const std::string& key) const {
  return Has(key) && node_->value->find(key)->is_object();
}

double JsonReader::Number(const std::string& key, double min, double max) {
  const Json* value = node_->Ask(key);
  const std::string want = WantedRange("a number", min, max);
  if (value == nullptr) {
    FailMissing(key, want);
    return Harmless(min, max);
  }
  const double number = value->is_number() ? value->get<double>() : NAN;
  if (number >= min && number <= max) return number;
  Fail(key, fmt::format("got {}, want {}", Shown(*value), want));
  return Harmless(min, max);
}

double JsonReader::NumberOr(const std::string& key, double fallback, double min, double max) {
  if (Has(key)) return Number(key, min, max);
  node_->MarkAsked(key);
  return fallback;
}

int JsonReader::IntegerOr(const std::string& key, int fallback, int min, int max) {
  const Json* value = node_->Ask(key);
  if (value == nullptr) return fallback;
  const double number = value->is_number() ? value->get<double>() : NAN;
  if (number >= min && number <= max && number == std::floor(number)) return int(number);
  Fail(key, fmt::format("got {}, want a whole number {}..{}", Shown(*value), min, max));
  return fallback;
}

bool JsonReader::BoolOr(const std::string& key, bool fallback) {
  const Json* value = node_->Ask(key);
  if (value == nullptr) return fallback;
  if (value->is_boolean()) return value->get<bool>();
  Fail(key, fmt::format("got {}, want true or false", Shown(*value)));
  return fallback;
}

std::string JsonReader::String(const std::string& key) {
  if (!Has(key)) {
    node_->MarkAsked(key);
    FailMissing(key, "a string");
    return {};
  }
  return StringOr(key, {});
}

std::string JsonReader::StringOr(const std::string& key, const std::string& fallback) {
  const Json* value = node_->Ask(key);
  if (value == nullptr) return fallback;
  if (value->is_string()) return value->get<std::string>();
  Fail(key, fmt::format("got {}, want a string", Shown(*value)));
  return fallback;
}

std::vector<double> JsonReader::Numbers(const std::string& key) {
  const Json* value = node_->Ask(key);
  std::vector<double> numbers;
  if (value == nullptr) {
    FailMissing(key, "an array of numbers");
  } else if (!value->is_array()) {
    Fail(key, fmt::format("got {}, want an array of numbers", Shown(*value)));
  } else if (!Flatten(*value, numbers)) {
    Fail(key, "got an array with something else in it, want numbers only");
    numbers.clear();
  }
  return numbers;
}

JsonReader JsonReader::Object(const std::string& key) {
  const Json* value = node_->Ask(key);
  auto child = std::make_shared<Node>();
  child->path = node_->PathOf(key);
  child->value = value != nullptr && value->is_object() ? value : nullptr;
  if (value == nullptr) {
    FailMissing(key, "an object");
  } else if (child->value == nullptr) {
    Fail(key, fmt::format("got {}, want an object", Shown(*value)));
  }
  node_->children.push_back(child);
  return JsonReader(document_, std::move(child));
}

std::vector<JsonReader> JsonReader::Objects(const std::string& key) {
  const Json* value = node_->Ask(key);
  std::vector<JsonReader> readers;
  if (value == nullptr) {
    FailMissing(key, "an array of objects");
    return readers;
  }
  if (!value->is_array()) {
    Fail(key, fmt::format("got {}, want an array of objects", Shown(*value)));
    return readers;
  }
  readers.reserve(value->size());
  for (const Json& item : *value) {
    auto child = std::make_shared<Node>();
    child->path = fmt::format("{}[{}]", node_->PathOf(key), readers.size());
    child->value = item.is_object() ? &item : nullptr;
    const std::string element = fmt::format("{}[{}]", key, readers.size());
    if (child->value == nullptr) Fail(element, fmt::format("got {}, want an object", Shown(item)));
    node_->children.push_back(child);
    readers.push_back(JsonReader(document_, std::move(child)));
  }
  return readers;
}

std::vector<std::string> JsonReader::Keys() const {
  std::vector<std::string> keys;
  if (node_->value != nullptr) {
    for (const auto& [key, ignored] : node_->value->items()) keys.push_back(key);
  }
  return keys;
}

void JsonReader::Ignore(const std::string& key) { node_->MarkAsked(key); }

void JsonReader::Fail(const std::string& key, const std::string& problem) {
  if (document_->first_error) return;
  const std::string path = node_->PathOf(key);
  document_->first_error = path.empty() ? problem : path + ": " + problem;
}

void JsonReader::FailMissing(const std::string& key, const std::string& want) {
  if (document_->first_error || node_->value == nullptr) return;
  Fail(key, "missing, want " + want);
  document_->first_error_is_a_missing_key = true;
}

Status JsonReader::Finish() const {
  // A misspelt key shows up as a missing one too; the misspelling is what the user can see.
  std::optional<std::string> problem = document_->first_error;
  if (!problem || document_->first_error_is_a_missing_key) {
    if (auto unknown = node_->UnknownKey()) problem = std::move(unknown);
  }
  if (!problem) return {};
  return UsageError(document_->name + ":" + *problem);
}

}  // namespace lorgnette
