// SPDX-License-Identifier: MIT
// A frame as data: a list of labelled passes, each of which names what it reads and the images it writes. An image
// exists only because a pass wrote it, so the order of the list is the order of the data and nothing is read early.
// Nothing here touches OpenGL; renderer/gl/flow_runner.h carries a flow out.
//
//     const Image map = flow.pass(scope, {.stage = Stage::ShadowMap, .name = "shadow-map", ...})[0];
//
// The list is written anew every frame from plain values, without allocating once the vectors have grown.
#pragma once

#include "renderer/core/fixed_vector.h"
#include "renderer/core/image.h"

#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace penumbra {

class Flow;
class Geometry; // something with vertices that a Draw pass can send through the rasteriser; see renderer/scene

// For grouping and sums; not a law of order.
enum class Stage : uint8_t { Scene, ShadowMap, Prefilter, Resolve, Lighting, Display };
std::string_view stageName(Stage stage);

// An image written by a pass of this frame.
class Image {
public:
    bool operator==(const Image&) const = default;
    int index() const { return index_; }

private:
    friend class Flow;
    template <class, size_t> friend class FixedVector;
    Image() = default;
    explicit Image(int index) : index_(index) {}
    int index_ = -1;
};

// An image of the last frame, as a pass of this frame may read it. All zero where there was none of this description.
class PastImage {
public:
    bool operator==(const PastImage&) const = default;
    int index() const { return index_; }    // of the flow's pasts()
    bool valid() const { return age_ > 0; } // false: there was none, it reads as zero
    int age() const { return age_; }        // for how many frames in a row there has been one
    int steps() const { return steps_; }    // that those frames took: one each, or as advance() has it

private:
    friend class Flow;
    PastImage(int index, int age, int steps) : index_(index), age_(age), steps_(steps) {}
    int index_;
    int age_;
    int steps_;
};

enum class Sampling : uint8_t {
    Nearest,
    Linear,
    LinearMipmap,
    Compare, // depth formats: hardware comparison reference <= stored, bilinear over the four results
};

// Compute shaders work in groups of so many by so many texels; see shaders/band.glsl.
inline constexpr int groupSide = 8;

// A set of tiles, each a group's row of texels, of images of one extent. Passes of this frame put tiles into it, and
// later ones run over those alone: software renderers, and groups of threads on a GPU, skip work only as a whole.
class TileSet {
public:
    bool operator==(const TileSet&) const = default;
    int index() const { return index_; } // of the flow's tileSets()

private:
    friend class Flow;
    template <class, size_t> friend class FixedVector;
    TileSet() = default;
    explicit TileSet(int index) : index_(index) {}
    int index_ = -1;
};

// One input of a pass; `sampler` is the name of the sampler in the shader, "name[0]" in an array of them.
struct Read {
    std::string_view sampler;
    std::variant<std::monostate, Image, PastImage> image;
    Sampling sampling = Sampling::Nearest;
    int anisotropy = 1; // of LinearMipmap: samples along the footprint's longer axis at most, up to the driver's limit
    bool operator==(const Read&) const = default;
};

struct Define {
    std::string_view name;
    int value = 1;
    bool operator==(const Define&) const = default;
};
using Defines = FixedVector<Define, 8>;

// One invocation per texel of the first written image. Further levels of what a pass writes are made of the first.
struct Compute {
    std::string_view shader; // file below shaders/
    Defines defines = {};
    std::optional<TileSet> over = {}; // only the texels of these tiles; the shader sees OVER_TILES
    bool operator==(const Compute&) const = default;
};

// Which faces are drawn. Shown: those that glTF shows, both of a two-sided material and else the front. Casting: those,
// and both of closed surfaces, so that a lamp within one is enclosed. Nearest: of closed surfaces only the front, which
// is the same where they are seen from outside, as the pass must see them: their back is never nearest.
enum class Faces : uint8_t { Casting, Both, Front, Back, Shown, Nearest };

// Geometry through the rasteriser, onto all written images and a depth buffer of its own or the written depth image.
// Clip depth is in [0, 1]. A colour image is cleared to `clear`, depth to its far end.
struct Draw {
    std::string_view shader;
    Defines defines = {};
    const Geometry* geometry = nullptr; // null: only clears
    uint64_t poseVersion = 0;           // equal versions: equal vertices
    Faces faces = Faces::Both;
    bool castersOnly = false;
    bool textured = false;      // the shader looks at base colour textures, not only at the masks of some
    bool reversedDepth = false; // nearer is greater: the far end is 0, else 1
    bool depthClamp = false;    // keep what lies before the near plane
    int border = 0;             // texels along the edge that stay cleared
    float clear[4] = {0, 0, 0, 0};
    bool operator==(const Draw&) const = default;
};

// Works out the vertices that skins and morph targets move, ahead of the draws of that pose version. Writes no image.
struct PoseVertices {
    std::string_view shader;
    const Geometry* geometry = nullptr;
    uint64_t poseVersion = 0;
    Defines defines = {};
    bool operator==(const PoseVertices&) const = default;
};

// Texels from the processor's memory into the one written image: all channels as floats, row 0 below as OpenGL has it.
// They are sent when they are others than the last frame's.
struct Supply {
    std::shared_ptr<const std::vector<float>> texels;
    bool operator==(const Supply&) const = default;
};

// The bytes of the std140 block `Constants` (binding 0) of a pass.
class Constants {
public:
    static constexpr size_t capacity = 1024;
    Constants() = default;
    template <class Block> Constants(const Block& block) : size_(sizeof(Block)) {
        static_assert(std::is_trivially_copyable_v<Block> && sizeof(Block) <= capacity && sizeof(Block) % 16 == 0);
        std::memcpy(bytes_.data(), &block, sizeof(Block));
    }
    const std::byte* data() const { return bytes_.data(); }
    size_t size() const { return size_; }
    bool operator==(const Constants& o) const {
        return size_ == o.size_ && std::memcmp(bytes_.data(), o.bytes_.data(), size_) == 0;
    }

private:
    std::array<std::byte, capacity> bytes_;
    size_t size_ = 0;
};

using Work = std::variant<Compute, Draw, PoseVertices, Supply>;

struct PassSpec {
    Stage stage = Stage::Resolve;
    std::string_view name; // kebab-case; with the scope it makes the label
    Work work;
    FixedVector<Read, 16> reads = {};
    FixedVector<ImageSpec, 5> writes = {};
    FixedVector<Image, 2> onto = {};    // images of earlier passes that it changes, ahead of those it makes; nobody may
                                        // mean the earlier texels any more
    FixedVector<TileSet, 2> marks = {}; // tile sets that it puts tiles into; see shaders/tiles.glsl
    Constants constants = {};
    const ParameterSet* parameters = nullptr; // the technique's block (binding 1), if the shader looks at it
};

// Who asks: the instance ("" when there is one, else "a", "b" ...) and the owner within it ("scene", "pcss").
// It becomes the front of labels, `a/pcss.shadow-map`.
struct Scope {
    std::string_view instance = {};
    std::string_view owner = {};
};

// What a frame is to the one before.
enum class Turn : uint8_t {
    Next,
    Again, // instead of it: what that one read of its past is read once more
};

class Flow {
public:
    struct ImageNode {
        ImageSpec spec;
        int label = 0;     // the label's number; text by label()
        int pass = 0;      // that wrote it
        int repeat = 0;    // iteration of flow.repeat, 0 outside
        bool kept = false; // somebody reads it as PastImage: two textures take turns
    };
    struct PassNode {
        Stage stage;
        int label;
        Work work;
        FixedVector<Read, 16> reads;
        FixedVector<Image, 5> writes{}; // those of `onto` first
        FixedVector<TileSet, 2> marks;
        Constants constants;
        const ParameterSet* parameters;
        FixedVector<uint32_t, 64> parameterBlock{};
    };
    struct PastNode {
        ImageSpec spec;
        int label;
        uint64_t key;
        int age;
        int steps;
        int advance = 1;
        bool finished = false;
    };
    struct TileNode {
        std::string_view name; // of the block in the shaders that mark, see shaders/tiles.glsl
        int label;
        int width, height; // tiles

        // As shaders/tiles.glsl has it, and a group's tiles more, so that none is read past the end.
        uint64_t bytes() const { return 4 * (8 + 2 * uint64_t(width) * uint64_t(height) + groupSide); }
    };
    using Writes = FixedVector<ImageSpec, 5>;

    // Starts a new frame: forgets the passes; remembers which images there were, for past().
    void begin(Turn turn = Turn::Next);

    // Appends a pass and returns the images it writes, in the order of spec.onto and then of spec.writes. A pass equal
    // to an earlier one of this frame in everything but its label is not run again: the earlier images are returned and
    // the label becomes another name for them.
    struct Outputs {
        FixedVector<int, 5> indices;
        Image operator[](size_t i) const { return Image(indices[i]); }
        operator Image() const {
            ensure(indices.size() == 1, "a pass with several images was used as one");
            return Image(indices[0]);
        }
    };
    Outputs pass(Scope scope, const PassSpec& spec);

    // An empty set of the tiles of images of this extent.
    TileSet tiles(Scope scope, std::string_view name, Extent extent);

    // Last frame's image of this label, storage and key, or zeros. Asking for it makes the flow keep it from now on.
    // The key stands for all that the image must have in common with this frame, such as the view.
    PastImage past(Scope scope, const ImageSpec& spec, uint64_t key = 0);
    // This frame takes so many steps of what the image is the sum of.
    void advance(PastImage image, int steps) { pasts_[static_cast<size_t>(image.index())].advance = steps; }
    // Nothing new will come of this image until its key is another.
    void finish(PastImage image) { pasts_[static_cast<size_t>(image.index())].finished = true; }
    // Whether another frame of the same inputs may look different.
    bool living() const;
    // How many frames in a row the longest history holds, this one among them; 0: nothing keeps any.
    int historyLength() const;
    // Forgets the past, so that the next frame is a first one.
    void forget();

    // Runs body(i) for i in [0, n). Passes of all rounds carry the same labels, and their timings sum. An image of
    // round i may be read in rounds i and i + 1 and, if of the last round, after the loop.
    template <class Body> void repeat(int n, Body&& body) {
        ensure(repeat_ == 0, "repeats do not nest");
        for (int i = 0; i < n; ++i) {
            repeat_ = i + 1;
            body(i);
        }
        lastRepeat_ = n;
        repeat_ = 0;
    }

    const std::vector<PassNode>& passes() const { return passes_; }
    const std::vector<ImageNode>& images() const { return images_; }
    const std::vector<PastNode>& pasts() const { return pasts_; }
    const std::vector<TileNode>& tileSets() const { return tileSets_; }
    TileSet tileSet(size_t index) const { return TileSet(static_cast<int>(index)); }
    const TileNode& node(TileSet tiles) const { return tileSets_[static_cast<size_t>(tiles.index_)]; }
    // Other names of images that several instances share: (label number, image index).
    const std::vector<std::pair<int, int>>& aliases() const { return aliases_; }

    const std::string& label(int number) const { return *labels_[static_cast<size_t>(number)]; }
    const ImageNode& node(Image image) const { return images_[static_cast<size_t>(image.index_)]; }
    const std::string& label(Image image) const { return label(node(image).label); }
    const ImageSpec& spec(Image image) const { return node(image).spec; }
    // The last image of that label, shared ones under each of their names.
    std::optional<Image> find(std::string_view label) const;
    Image image(int index) const { return Image(index); }

    // Bytes of all textures that this frame holds, rounds of a repeat and kept pasts counted as they are stored; and of
    // its sets of tiles.
    uint64_t bytes() const;
    // Throws InputError that names the largest images and their sizes if the frame would hold more than `limit` bytes.
    void refuseAbove(uint64_t limit) const;

private:
    struct Remembered {
        int label;
        ImageSpec spec;
        uint64_t key;
        int age, steps;
    };
    int intern(Scope scope, std::string_view name);

    std::vector<PassNode> passes_;
    std::vector<ImageNode> images_;
    std::vector<PastNode> pasts_;
    std::vector<TileNode> tileSets_;
    std::vector<std::pair<int, int>> aliases_;
    std::vector<std::unique_ptr<std::string>> labels_; // interned for the life of the flow
    std::vector<Remembered> lastImages_;               // that this frame can read
    std::vector<int> kept_;                            // labels ever asked for by past()
    std::vector<uint32_t> packed_;
    int repeat_ = 0, lastRepeat_ = 0;
};

} // namespace penumbra
