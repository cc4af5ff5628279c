#include "fovea/simplify/vertex_notes.h"

#include <gtest/gtest.h>

#include <map>

#include "fovea/base/random.h"

namespace fovea {
namespace {

TEST(VertexNotes, KeepANumberForEachVertexUntilCleared) {
  Random random(3);
  VertexNotes notes;
  for (const std::uint32_t count : {1u, 12u, 100u, 5000u, 6u}) {
    notes.clear(count);
    std::map<std::uint32_t, std::uint32_t> expected;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t v = random.below(count) * 64;  // some of them twice
      std::uint32_t& note = notes[notes.place(v)];
      EXPECT_EQ(note, expected[v]);
      note = expected[v] = i + 1;
    }
    for (const auto& [v, number] : expected) EXPECT_EQ(notes[notes.place(v)], number);
  }
}

}  // namespace
}  // namespace fovea
