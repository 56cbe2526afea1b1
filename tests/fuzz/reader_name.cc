// SPDX-License-Identifier: Apache-2.0
// The reader that a fuzz target looks at (reader_fuzz.cc).
extern const char* const kFuzzedReader;
const char* const kFuzzedReader = LG_FUZZ_READER;
