// tests/schema/corpus.h -- files from which the readers show what they take.
#pragma once

#include <string>
#include <vector>

#include "tests/schema/key_facts.h"

namespace cordis::test {

/// A file that Cordis reads: what sort it is of, where it stands, its text.
struct Document {
  std::string sort;  ///< "scene", "launch" or "device"
  std::string name;
  std::string text;
  bool is_part = false;  ///< what it lacks at its top level stands in another file
};

/// Every scene, launch file and device file that ships, and every one of the documents.
std::vector<Document> shipped_documents();

/// Files that show each mapping and each kind that the readers know, some of them incomplete.
std::vector<Document> cover_documents();

/// Reads a document as the programs do, as far as its keys go.
void read(const Document& document, config::Problems& problems);

/// What the readers ask of all documents of a sort. Of devices those of cover_documents() alone: a
/// driver may read another's mapping.
FileFacts facts_of(const std::string& sort);

/// Adds what the readers ask of variations of the cover documents of a sort: no key is new, and what
/// one document happened to show gets less strict.
void add_variations(const std::string& sort, FileFacts& facts);

}  // namespace cordis::test
