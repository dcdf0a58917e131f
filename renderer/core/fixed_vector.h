// SPDX-License-Identifier: MIT
// A vector with its storage inside: describing a frame allocates nothing.
#pragma once

#include "renderer/core/error.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>

namespace penumbra {

template <class T, size_t Capacity> class FixedVector {
public:
    FixedVector() = default;
    FixedVector(std::initializer_list<T> items) {
        for (const T& item : items) push_back(item);
    }
    void push_back(const T& item) {
        ensure(size_ < Capacity, "a fixed vector is full");
        items_[size_++] = item;
    }
    void pop_back() { --size_; }
    void clear() { size_ = 0; }
    size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T* begin() { return items_; }
    T* end() { return items_ + size_; }
    const T* begin() const { return items_; }
    const T* end() const { return items_ + size_; }
    const T* data() const { return items_; }
    T& operator[](size_t i) { return items_[i]; }
    const T& operator[](size_t i) const { return items_[i]; }
    bool operator==(const FixedVector& other) const { return std::equal(begin(), end(), other.begin(), other.end()); }

private:
    T items_[Capacity]{};
    size_t size_ = 0;
};

} // namespace penumbra
