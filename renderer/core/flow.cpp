// SPDX-License-Identifier: MIT
#include "renderer/core/flow.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra {

const FormatInfo& info(Format format) {
    static constexpr FormatInfo table[] = {
        {"RGBA8", 4, 4},           {"RG16", 2, 4},     {"RGBA16", 4, 8},
        {"RGBA16_SNORM", 4, 8},    {"R16F", 1, 2},     {"RG16F", 2, 4},
        {"RGBA16F", 4, 8},         {"R32F", 1, 4},     {"RG32F", 2, 8},
        {"RGBA32F", 4, 16},        {"DEPTH32F", 1, 4}, {"RG32UI", 2, 8, true},
        {"RGBA32UI", 4, 16, true},
    };
    return table[static_cast<size_t>(format)];
}

uint64_t ImageSpec::bytes() const {
    uint64_t texels = 0;
    for (int level = 0; level < extent.levels; ++level)
        texels += uint64_t(std::max(extent.width >> level, 1)) * uint64_t(std::max(extent.height >> level, 1));
    return texels * uint64_t(extent.layers) * uint64_t(extent.samples) * uint64_t(info(format).bytesPerTexel);
}

std::string_view stageName(Stage stage) {
    static constexpr std::string_view names[] = {"Scene", "ShadowMap", "Prefilter", "Resolve", "Lighting", "Display"};
    return names[static_cast<size_t>(stage)];
}

void Flow::begin(Turn turn) {
    if (turn == Turn::Next) lastImages_.clear();
    for (const ImageNode& image : images_) {
        if (!image.kept || turn == Turn::Again) continue;
        Remembered& last = lastImages_.emplace_back(Remembered{image.label, image.spec, 0, 1, 1});
        for (const PastNode& past : pasts_)
            if (past.label == image.label)
                last.key = past.key, last.age = past.age + 1, last.steps = past.steps + past.advance;
    }
    passes_.clear();
    images_.clear();
    pasts_.clear();
    tileSets_.clear();
    aliases_.clear();
    repeat_ = lastRepeat_ = 0;
}

// Labels are compared piece by piece, so that a known label costs no allocation.
int Flow::intern(Scope scope, std::string_view name) {
    const auto equal = [&](std::string_view text) {
        const auto take = [&](std::string_view piece) {
            if (!text.starts_with(piece)) return false;
            text.remove_prefix(piece.size());
            return true;
        };
        return (scope.instance.empty() || (take(scope.instance) && take("/"))) &&
               (scope.owner.empty() || (take(scope.owner) && take("."))) && text == name;
    };
    for (size_t i = 0; i < labels_.size(); ++i)
        if (equal(*labels_[i])) return static_cast<int>(i);
    std::string text;
    if (!scope.instance.empty()) text += std::string(scope.instance) + "/";
    if (!scope.owner.empty()) text += std::string(scope.owner) + ".";
    labels_.push_back(std::make_unique<std::string>(text + std::string(name)));
    return static_cast<int>(labels_.size()) - 1;
}

Flow::Outputs Flow::pass(Scope scope, const PassSpec& spec) {
    ensure(!spec.writes.empty() || !spec.onto.empty() || std::holds_alternative<PoseVertices>(spec.work),
           "a pass writes nothing");
    for (const Read& read : spec.reads) {
        if (const Image* image = std::get_if<Image>(&read.image)) {
            ensure(image->index_ >= 0 && image->index_ < static_cast<int>(images_.size()), "a read of no image");
            const int round = node(*image).repeat;
            ensure(round == 0 || round == repeat_ || round == repeat_ - 1 || (repeat_ == 0 && round == lastRepeat_),
                   "an image of an earlier round of a repeat was read too late");
        } else {
            ensure(std::holds_alternative<PastImage>(read.image), "a read without an image");
        }
    }
    packed_.clear();
    if (spec.parameters) packBlock(*spec.parameters, packed_);

    const auto sameWrites = [&](const PassNode& pass) {
        const size_t old = spec.onto.size();
        if (pass.writes.size() != old + spec.writes.size()) return false;
        for (size_t i = 0; i < old; ++i)
            if (pass.writes[i] != spec.onto[i]) return false;
        for (size_t i = 0; i < spec.writes.size(); ++i)
            if (!node(pass.writes[old + i]).spec.sameStorage(spec.writes[i]) ||
                node(pass.writes[old + i]).spec.name != spec.writes[i].name)
                return false;
        return true;
    };
    Work work = spec.work;
    if (Compute* compute = std::get_if<Compute>(&work); compute && compute->over)
        compute->defines.push_back({"OVER_TILES"});
    for (const PassNode& pass : passes_) {
        const int round = pass.writes.empty() ? 0 : node(pass.writes[0]).repeat;
        const bool sameParameters = pass.parameters && spec.parameters ? *pass.parameters == *spec.parameters
                                                                       : pass.parameters == spec.parameters;
        if ((round == 0 || round == repeat_) && pass.work == work && pass.reads == spec.reads &&
            pass.marks == spec.marks && pass.constants == spec.constants && sameParameters && sameWrites(pass)) {
            Outputs outputs;
            for (const Image image : pass.writes) {
                const int label = intern(scope, node(image).spec.name);
                if (label != node(image).label) aliases_.push_back({label, image.index_});
                outputs.indices.push_back(image.index_);
            }
            return outputs;
        }
    }

    PassNode pass{.stage = spec.stage,
                  .label = intern(scope, spec.name),
                  .work = work,
                  .reads = spec.reads,
                  .marks = spec.marks,
                  .constants = spec.constants,
                  .parameters = spec.parameters};
    for (const uint32_t scalar : packed_) pass.parameterBlock.push_back(scalar);
    Outputs outputs;
    for (const Image image : spec.onto) {
        pass.writes.push_back(image);
        outputs.indices.push_back(image.index_);
    }
    for (const ImageSpec& image : spec.writes) {
        const int label = intern(scope, image.name);
        for (const ImageNode& other : images_)
            ensure(other.label != label || (repeat_ != 0 && other.repeat != 0 && other.repeat != repeat_),
                   "two images have one label");
        const bool kept = std::find(kept_.begin(), kept_.end(), label) != kept_.end();
        ensure(!kept || repeat_ <= 1, "an image of a repeat cannot be kept");
        images_.push_back({image, label, static_cast<int>(passes_.size()), repeat_, kept});
        const int index = static_cast<int>(images_.size()) - 1;
        pass.writes.push_back(Image(index));
        outputs.indices.push_back(index);
    }
    passes_.push_back(pass);
    return outputs;
}

TileSet Flow::tiles(Scope scope, std::string_view name, Extent extent) {
    ensure(extent.layers == 1, "tiles of a layered image");
    tileSets_.push_back({name, intern(scope, name), (extent.width + groupSide - 1) / groupSide, extent.height});
    return TileSet(static_cast<int>(tileSets_.size()) - 1);
}

PastImage Flow::past(Scope scope, const ImageSpec& spec, uint64_t key) {
    const int label = intern(scope, spec.name);
    if (std::find(kept_.begin(), kept_.end(), label) == kept_.end()) kept_.push_back(label);
    const auto last = std::find_if(lastImages_.begin(), lastImages_.end(), [&](const Remembered& image) {
        return image.label == label && image.spec.sameStorage(spec) && image.key == key;
    });
    const bool found = last != lastImages_.end();
    const int age = found ? last->age : 0, steps = found ? last->steps : 0;
    // What cannot be read is lost: its texture is cleared.
    if (age == 0) std::erase_if(lastImages_, [&](const Remembered& image) { return image.label == label; });
    pasts_.push_back({spec, label, key, age, steps});
    return PastImage(static_cast<int>(pasts_.size()) - 1, age, steps);
}

bool Flow::living() const {
    return std::any_of(pasts_.begin(), pasts_.end(), [](const PastNode& past) { return !past.finished; });
}

int Flow::historyLength() const {
    int length = 0;
    for (const PastNode& past : pasts_) length = std::max(length, past.age + 1);
    return length;
}

void Flow::forget() {
    lastImages_.clear();
    for (ImageNode& image : images_) image.kept = false;
}

std::optional<Image> Flow::find(std::string_view wanted) const {
    for (size_t i = images_.size(); i-- > 0;)
        if (label(images_[i].label) == wanted) return Image(static_cast<int>(i));
    for (const auto& [number, index] : aliases_)
        if (label(number) == wanted) return Image(index);
    return std::nullopt;
}

uint64_t Flow::bytes() const {
    uint64_t sum = 0;
    for (const ImageNode& image : images_)
        if (image.repeat <= 2) sum += image.spec.bytes() * (image.kept ? 2 : 1); // rounds take turns with two textures
    for (const TileNode& tiles : tileSets_) sum += tiles.bytes();
    return sum;
}

void Flow::refuseAbove(uint64_t limit) const {
    if (bytes() <= limit) return;
    std::vector<const ImageNode*> largest;
    for (const ImageNode& image : images_)
        if (image.repeat <= 1) largest.push_back(&image);
    std::stable_sort(largest.begin(), largest.end(),
                     [](const ImageNode* a, const ImageNode* b) { return a->spec.bytes() > b->spec.bytes(); });
    std::string names;
    for (size_t i = 0; i < std::min<size_t>(largest.size(), 3); ++i) {
        const ImageSpec& spec = largest[i]->spec;
        names += fmt::format("{}{} {}x{}{} {} = {} MiB", i ? ", " : "", label(largest[i]->label), spec.extent.width,
                             spec.extent.height, spec.extent.layers > 1 ? fmt::format("x{}", spec.extent.layers) : "",
                             info(spec.format).name, spec.bytes() >> 20);
    }
    throw InputError(fmt::format("the frame would hold {} MiB of textures, the limit is {} MiB; the largest: {}",
                                 bytes() >> 20, limit >> 20, names));
}

} // namespace penumbra
