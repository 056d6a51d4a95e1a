// cli/session_words.h -- the words that name a running session, the same for all verbs.
#pragma once

#include <string>

#include "cli/command_line.h"
#include "cli/session_address.h"

namespace cordis::cli {

/// A session, or a whole domain.
struct SessionWords {
  std::string session;
  std::string domain;
  std::string name;
  std::string keyring;

  /// @throws UsageError when nothing is named, else as address_of(). The session is empty for a
  /// whole domain.
  SessionAddress address() const {
    if (!session.empty()) return address_of(session, domain, name, /*is_any=*/false, keyring);
    if (domain.empty())
      throw UsageError("which session? name one, or a whole domain with --domain");
    SessionAddress address = address_of("any", domain, "", /*is_any=*/true, keyring);
    address.session.clear();
    return address;
  }
};

/// The two words of a verb that reads topics: a session, and a pattern of topics.
inline void add_topic_words(Verb& verb, SessionWords& words, std::string& topic) {
  verb.optional_word("SESSION", words.session, "The launch file, or the name of the session");
  verb.optional_word("TOPIC", topic, "A topic, or a pattern: 'gesture/*'");
}

inline void add_session_options(Verb& verb, SessionWords& words) {
  verb.option("--domain", "N", words.domain,
              "DDS domain, for a session that another user or host began");
  verb.option("--session", "NAME", words.name,
              "Name of the session, when it is not that of the file");
  verb.option("--security", "FOLDER", words.keyring,
              "Keys for a secured session that another user or host began");
}

}  // namespace cordis::cli
