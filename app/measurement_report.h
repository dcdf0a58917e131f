// SPDX-License-Identifier: MIT
// What was measured as a document: printed as a table, as rows of comma-separated values or as JSON, and joined of
// parts.
#pragma once

#include "app/json_text.h"
#include "renderer/core/technique.h"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

// {"least", "most"} of a technique's texture reads a pixel, or null; and as a text, "16-32" or nothing.
Json readsJson(const Technique& technique);
std::string readsText(const Json& reads);

// Sets "front" of every result: whether no other one is at least as cheap and as close, and better in one of the two.
void markFront(Json& document);

std::string measurementTable(const Json& document);
// A row for each result; where the camera or the scene moves, for each of its frames.
std::string measurementCsv(const Json& document);

// Joins documents in files. Throws InputError that names the file if one is not such a document, or is of another
// version, scene, view or truth than the first, or has a row that another has.
Json mergeMeasurements(const std::vector<std::string>& files);

} // namespace penumbra
