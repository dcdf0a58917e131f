// SPDX-License-Identifier: MIT
#include "app/image_file.h"

#include "app/file_io.h"
#include "renderer/core/error.h"
#include "tests/app/picture_reader.h"
#include "tests/app/program.h"
#include "tests/catch.h"

#include <bit>
#include <cmath>
#include <limits>

using namespace penumbra;
using namespace penumbra::test;

namespace {

struct Reader {
    const char* name;
    ReadPicture (*read)(const std::filesystem::path&);
};

Picture ramp(int width, int height, std::vector<std::string> channels) {
    Picture picture{width, height, std::move(channels)};
    const size_t count = static_cast<size_t>(width) * static_cast<size_t>(height) * picture.channels.size();
    for (size_t i = 0; i < count; ++i)
        picture.values.push_back(static_cast<float>(i) / static_cast<float>(count) - 0.1f);
    return picture;
}

void requireSameBits(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    for (size_t i = 0; i < a.size(); ++i)
        if (std::bit_cast<uint32_t>(a[i]) != std::bit_cast<uint32_t>(b[i]))
            FAIL("value " << i << ": " << a[i] << " " << b[i]);
}

} // namespace

TEST_CASE("float pictures come back bit for bit, NaN and infinities too") {
    const TemporaryFolder folder;
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 2), std::pair(37, 65), std::pair(300, 40)}) {
        Picture picture = ramp(width, height, {"value"});
        picture.values.front() = std::numeric_limits<float>::quiet_NaN();
        if (picture.values.size() > 2) {
            picture.values[1] = std::numeric_limits<float>::infinity();
            picture.values[2] = std::numeric_limits<float>::denorm_min();
        }
        for (const auto& [name, read] :
             {Reader{"a.exr", readExr}, Reader{"a.pfm", readPfm}, Reader{"a.npy", readNpy}}) {
            INFO(name << " " << width << "x" << height);
            writePicture(folder / name, picture);
            const ReadPicture back = read(folder / name);
            CHECK(back.width == width);
            CHECK(back.height == height);
            CHECK(back.channels.size() == 1);
            requireSameBits(back.values, picture.values);
        }
    }
}

TEST_CASE("several channels keep their order, and OpenEXR's are sorted by name") {
    const TemporaryFolder folder;
    const Picture picture = ramp(5, 4, {"R", "G", "B"});
    for (const auto& [name, read] : {Reader{"a.pfm", readPfm}, Reader{"a.npy", readNpy}}) {
        writePicture(folder / name, picture);
        requireSameBits(read(folder / name).values, picture.values);
    }
    writePicture(folder / "a.exr", picture);
    const ReadPicture exr = readExr(folder / "a.exr");
    CHECK(exr.channels == std::vector<std::string>{"B", "G", "R"});
    CHECK(exr.values[0] == picture.values[2]);
    CHECK(exr.values[2] == picture.values[0]);

    CHECK_THROWS_AS(writePicture(folder / "two.pfm", ramp(2, 2, {"x", "y"})), InputError);
    CHECK_FALSE(std::filesystem::exists(folder / "two.pfm"));
}

TEST_CASE("a PNG rounds to the nearest of 256 steps and clamps") {
    const TemporaryFolder folder;
    const Picture picture{3, 2, {"grey"}, {-1, 0, 0.5f, 0.999f, 1, 7}};
    writePicture(folder / "a.png", picture);
    CHECK(readPng(folder / "a.png").values == std::vector<float>{0, 0, 128, 255, 255, 255});
}

TEST_CASE("facts are in the file, in any language") {
    const TemporaryFolder folder;
    const Json facts = {{"scene", "Hof mit Bäumen, ψ"}, {"parameters", {{"kernel", 9}}}, {"time", 0.1}};
    writePicture(folder / "a.png", ramp(4, 4, {"grey"}), facts);
    const ReadPicture png = readPng(folder / "a.png");
    CHECK(png.facts.size() == 1);
    CHECK(Json::parse(png.facts.at("penumbra")) == facts);
    CHECK(readPictureFacts(folder / "a.png") == facts);

    writePicture(folder / "a.exr", ramp(4, 4, {"grey"}), facts);
    const ReadPicture exr = readExr(folder / "a.exr");
    CHECK(exr.facts.size() == facts.size());
    for (const auto& [key, fact] : facts.items()) CHECK(Json::parse(exr.facts.at("penumbra." + key)) == fact);
    CHECK(readPictureFacts(folder / "a.exr") == facts);
}

TEST_CASE("pictures without facts have none, and broken ones are refused by name") {
    const TemporaryFolder folder;
    for (const std::string name : {"a.png", "a.exr"}) {
        const auto file = folder / name;
        writePicture(file, ramp(4, 4, {"grey"}));
        CHECK(readPictureFacts(file).is_null());
        writePicture(file, ramp(4, 4, {"grey"}), {{"scene", "a scene with a long name, so that there is much to cut"}});
        const std::string whole = readAll(file);
        for (const size_t size : {size_t{0}, size_t{3}, size_t{20}, size_t{60}, size_t{90}}) {
            writeAll(file, whole.substr(0, size));
            CHECK(contains(refusal([&] { readPictureFacts(file); }), file.string()));
        }
        writeAll(file, "no picture at all, but long enough for the header of one");
        CHECK(contains(refusal([&] { readPictureFacts(file); }), file.string()));
    }
    CHECK(contains(refusal([&] { readPictureFacts(folder / "missing.png"); }), "No such file"));
    CHECK(contains(refusal([&] { readPictureFacts(folder.path()); }), "not a regular file"));
}

TEST_CASE("an unknown ending is refused with the known ones") {
    for (const char* name : {"a.bmp", "png", ".png"})
        CHECK(refusal([&] { pictureFormat(name); }) ==
              std::string(name) + ": pictures end in .png, .exr, .pfm or .npy");
}

TEST_CASE("writing leaves no temporary file behind and keeps the old file on failure") {
    const TemporaryFolder folder;
    writeFileAtomically(folder / "a", "one");
    writeFileAtomically(folder / "a", "two");
    CHECK(readAll(folder / "a") == "two");
    CHECK_THROWS_AS(writeFileAtomically(folder / "missing/a", "x"), InputError);
    CHECK_THROWS_AS(writeFileAtomically(folder.path(), "x"), InputError);
    checkWritable(folder / "b");
    const auto entries = std::distance(std::filesystem::directory_iterator(folder.path()), {});
    CHECK(entries == 1);
}
