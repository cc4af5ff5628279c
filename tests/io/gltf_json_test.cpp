#include "fovea/io/gltf_json.h"

#include <gtest/gtest.h>

#include "fovea/base/error.h"
#include "fovea/io/glb.h"
#include "fovea/io/gltf_references.h"
#include "fovea/io/uri.h"
#include "support/gltf_builder.h"

namespace fovea::gltf {
namespace {

using test::to_bytes;

constexpr std::int64_t kPlenty = std::int64_t{1} << 30;

Json parse(const std::string& text, std::int64_t max_bytes = kPlenty) {
  ByteBudget budget(max_bytes);
  return parse_json(to_bytes(text), "f.gltf", 20, budget);
}

template <class F>
Error error_of(F&& f) {
  try {
    f();
  } catch (const Error& e) {
    return e;
  }
  return Error(ErrorKind::internal, "nothing was thrown");
}

TEST(GltfJson, ParsesAllKindsAndKeepsOrder) {
  const std::string text = R"({"z":1,"a":[true,false,null,-2,18446744073709551615,0.1,"é\n"],"m":{}})";
  EXPECT_EQ(parse(text).dump(), text);
}

TEST(GltfJson, SyntaxErrorsNameTheByteInTheFile) {
  // Offset 20 of the text in the file, and the "x" is its sixth character.
  const Error e = error_of([] { parse(R"({"a":x})"); });
  EXPECT_EQ(e.kind(), ErrorKind::format);
  EXPECT_EQ(e.place(), "f.gltf: byte 25");
  for (const char* text :
       {"", "{", "[1,]", "{\"a\" 1}", "\"\xff\"", "nul", "{\"a\":1}}", "1e999", "\"\\ud800\""}) {
    EXPECT_EQ(error_of([&] { parse(text); }).kind(), ErrorKind::format) << text;
  }
}

TEST(GltfJson, DeepNestingAndHugeTreesAreRefused) {
  EXPECT_NO_THROW(parse(std::string(kMaxJsonDepth, '[') + std::string(kMaxJsonDepth, ']')));
  EXPECT_EQ(error_of([] { parse(std::string(1'000'000, '[')); }).kind(), ErrorKind::limit);
  std::string many = "[0";
  for (int i = 0; i < 1000; ++i) many += ",0";
  EXPECT_NO_THROW(parse(many + "]", 100'000));
  EXPECT_EQ(error_of([&] { parse(many + "]", 10'000); }).kind(), ErrorKind::limit);
}

TEST(GltfJson, DoubleMembersAreRefusedAlsoInHugeObjects) {
  const Error e = error_of([] { parse(R"({"b":1,"a":1,"b":2})"); });
  EXPECT_EQ(e.kind(), ErrorKind::format);
  EXPECT_NE(e.message().find("\"b\""), std::string::npos);
  // Quadratic work would take minutes here.
  std::string text = "{\"x\":0";
  for (int i = 0; i < 300'000; ++i) text += ",\"k" + std::to_string(i) + "\":0";
  EXPECT_EQ(parse(text + "}").size(), 300'001u);
}

TEST(GltfJson, ViewsCheckTypesAndNameThePlace) {
  const std::string file = "f.gltf";
  const Json json = parse(R"({"n":5.0,"f":0.5,"s":"x","list":[1,"a"],"a/b~c":{"i":7},"big":1e300,"neg":-1})");
  const JsonView view(json, "", file);
  EXPECT_EQ(view.at("n").integer(0, 10), 5);
  EXPECT_EQ(view.number("missing", 2.5), 2.5);
  EXPECT_EQ(view.index("missing", 3, "things"), -1);
  EXPECT_EQ(view.at("a/b~c").place(), "f.gltf: /a~1b~0c");
  struct Case {
    std::function<void()> call;
    const char* place;
  };
  const Case cases[] = {{[&] { view.at("f").integer(0, 10); }, "f.gltf: /f"},
                        {[&] { view.at("n").integer(0, 4); }, "f.gltf: /n"},
                        {[&] { view.at("big").size(); }, "f.gltf: /big"},
                        {[&] { view.at("neg").size(); }, "f.gltf: /neg"},
                        {[&] { view.at("s").number(); }, "f.gltf: /s"},
                        {[&] { view.at("n").text(); }, "f.gltf: /n"},
                        {[&] { view.at("n").elements(); }, "f.gltf: /n"},
                        {[&] { view.at("n").find("x"); }, "f.gltf: /n"},
                        {[&] { view.at("n").boolean(); }, "f.gltf: /n"},
                        {[&] { view.at("list").numbers(); }, "f.gltf: /list"},
                        {[&] { view.at("a/b~c").index("i", 7, "things"); }, "f.gltf: /a~1b~0c/i"},
                        {[&] { view.at("nothing"); }, "f.gltf"}};
  for (const Case& c : cases) {
    const Error e = error_of(c.call);
    EXPECT_EQ(e.kind(), ErrorKind::format);
    EXPECT_EQ(e.place(), c.place);
  }
}

TEST(GltfJson, MessagesShowFileContentSafely) {
  EXPECT_EQ(shown("a\x1b[31m\"b"), R"("a\u001b[31m\"b")");
  EXPECT_LT(shown(std::string(10'000, 'x')).size(), 100u);
  EXPECT_EQ(pointer_step("a\nb"), "a\\u000ab");
}

TEST(GltfReferences, OnlyDataIndicesInsideExtensionsAreVisited) {
  Json object = parse(R"({
    "bufferView": 1, "attributes": {"POSITION": 2}, "extras": {"extensions": {"X": {"accessor": 3}}},
    "extensions": {
      "A": {"accessor": 4, "list": [{"bufferView": 5}], "attributes": {"_ID": 6, "text": "no"}, "index": 7},
      "EXT_structural_metadata": {"propertyTables": [{"properties": {"p": {"values": 8, "arrayOffsets": 9}}}]},
      "B": {"values": 10, "attributes": [{"n": 11}], "colorAccessor": 12}}})");
  std::string found;
  visit_data_references(object, [&](DataReference kind, Json& number, const std::string& pointer) {
    found += (kind == DataReference::accessor ? "a" : "v") + number.dump() + pointer + "\n";
  });
  EXPECT_EQ(found,
            "a4/extensions/A/accessor\n"
            "v5/extensions/A/list/0/bufferView\n"
            "a6/extensions/A/attributes/_ID\n"
            "v8/extensions/EXT_structural_metadata/propertyTables/0/properties/p/values\n"
            "v9/extensions/EXT_structural_metadata/propertyTables/0/properties/p/arrayOffsets\n"
            "a12/extensions/B/colorAccessor\n");
}

TEST(Uri, DataUris) {
  const auto text = [](const char* uri) {
    const auto bytes = decode_data_uri(uri).bytes;
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  EXPECT_TRUE(is_data_uri("DATA:,x"));
  EXPECT_FALSE(is_data_uri("data.bin"));
  EXPECT_EQ(text("data:;base64,aGVsbG8="), "hello");
  EXPECT_EQ(text("data:a/b;base64,aGVs\nbG8"), "hello");  // no padding, a line break
  EXPECT_EQ(text("data:;base64,_-8"), "\xff\xef");        // URL alphabet
  EXPECT_EQ(text("data:;base64,"), "");
  EXPECT_EQ(text("data:text/plain,a%20b"), "a b");
  EXPECT_EQ(decode_data_uri("data:IMAGE/PNG;charset=x;base64,AA==").mime_type, "image/png");
  for (const char* bad :
       {"data:;base64", "data:;base64,a", "data:;base64,a*bc", "data:;base64,aa=a", "data:,%4"}) {
    EXPECT_EQ(error_of([&] { decode_data_uri(bad); }).kind(), ErrorKind::format) << bad;
  }
}

TEST(Uri, PathsStayBelowTheFolder) {
  EXPECT_EQ(relative_path_of_uri("a/b.bin"), "a/b.bin");
  EXPECT_EQ(relative_path_of_uri("Box%20With%20Spaces.bin"), "Box With Spaces.bin");
  EXPECT_EQ(relative_path_of_uri("x/../%E2%9D%A4.png"), "❤.png");
  EXPECT_EQ(relative_path_of_uri("./a"), "a");
  for (const char* bad : {"", ".", "..", "../a", "a/../../b", "/etc/passwd", "%2Fetc%2Fpasswd", "%2e%2e/a",
                          "file:///a", "http://a/b", "C:/a", "a%00b", "a%zz", "a%2"}) {
    EXPECT_EQ(error_of([&] { relative_path_of_uri(bad); }).kind(), ErrorKind::format) << bad;
  }
}

TEST(Glb, ChunksAreFoundAndUnknownOnesSkipped) {
  auto file = test::GltfBuilder::glb("{}", to_bytes("data"));
  const GlbChunks chunks = split_glb(file, "f.glb");
  EXPECT_EQ(chunks.json_offset, 20u);
  EXPECT_EQ(chunks.json.size(), 4u);
  ASSERT_TRUE(chunks.binary.has_value());
  EXPECT_EQ(chunks.binary->size(), 4u);

  file[28] = std::byte{'?'};  // type of the second chunk
  EXPECT_FALSE(split_glb(file, "f.glb").binary.has_value());
}

TEST(Glb, LengthsThatContradictTheFileNameTheByte) {
  const auto good = test::GltfBuilder::glb("{}", to_bytes("data"));
  const auto place_with = [&](std::size_t offset, std::uint8_t value) {
    auto file = good;
    file[offset] = std::byte{value};
    return error_of([&] { split_glb(file, "f.glb"); }).place();
  };
  EXPECT_EQ(place_with(4, 1), "f.glb: byte 4");      // version
  EXPECT_EQ(place_with(8, 255), "f.glb: byte 8");    // length of the file
  EXPECT_EQ(place_with(8, 5), "f.glb: byte 8");      // less than the header
  EXPECT_EQ(place_with(15, 255), "f.glb: byte 12");  // length of the first chunk
  EXPECT_EQ(place_with(16, 'X'), "f.glb: byte 16");  // its type
  EXPECT_EQ(place_with(27, 255), "f.glb: byte 24");  // length of the second chunk
  for (std::size_t length = 4; length < good.size(); ++length) {
    const auto cut = std::span(good).first(length);
    EXPECT_EQ(error_of([&] { split_glb(cut, "f.glb"); }).kind(), ErrorKind::format) << length;
  }
}

}  // namespace
}  // namespace fovea::gltf
