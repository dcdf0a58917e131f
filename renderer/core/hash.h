// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace penumbra {

// A 64-bit number that tells contents apart: not a safe hash, but one that no accident makes equal. A word costs two
// multiplications; finalisation of MurmurHash3 (Appleby).
class Hash {
public:
    template <class T> void add(const T& value) {
        static_assert(std::is_floating_point_v<T> || std::has_unique_object_representations_v<T>,
                      "padding has no value");
        addBytes(&value, sizeof(value));
    }
    template <class T> void add(const std::vector<T>& values) {
        add(static_cast<uint64_t>(values.size()));
        addBytes(values.data(), values.size() * sizeof(T));
    }
    void addBytes(const void* data, size_t size) {
        const char* bytes = static_cast<const char*>(data);
        for (; size >= 8; bytes += 8, size -= 8) addWord(bytes, 8);
        if (size > 0) addWord(bytes, size);
    }
    uint64_t value() const { return mixed(state_); }

private:
    static uint64_t mixed(uint64_t x) {
        x = (x ^ (x >> 33)) * 0xff51afd7ed558ccd;
        x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53;
        return x ^ (x >> 33);
    }
    void addWord(const char* bytes, size_t size) {
        uint64_t word = 0;
        std::memcpy(&word, bytes, size);
        state_ = (state_ ^ mixed(word + size)) * 0x9e3779b97f4a7c15 + 0x2545f4914f6cdd1d;
        state_ ^= state_ >> 29;
    }
    uint64_t state_ = 0x243f6a8885a308d3;
};

} // namespace penumbra
