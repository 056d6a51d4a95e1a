// viz_node/web/server.h -- serves the page and what it shows, over HTTP and WebSocket.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "viz_node/pointer_server.h"
#include "viz_node/scene_mirror.h"
#include "viz_node/topic_board.h"

namespace cordis::viz {

struct ServerConfig {
  std::string node = "viz";  ///< name of the node, for messages
  std::string session;
  std::string address = "127.0.0.1";
  int port = 0;                  ///< the first that is tried; 0 takes any free port
  std::filesystem::path folder;  ///< the built page
  std::string token;             ///< what a page must know to command, beyond loopback
  PageRights rights;             ///< rights of pages that may command
  bool is_view_only = false;     ///< no page may command or drag
  std::uint64_t epoch = 0;       ///< identifies this life of the node
  TopicBoard* topics = nullptr;  ///< what Foxglove reads, outlives the server; null: it is refused
};

/// What the server has done. Delays run from the hand to the view, until a page said that it has
/// drawn a frame. They begin at the newest device sample that the frame shows, or at the frame
/// itself while no device plays.
struct ServerFigures {
  std::uint64_t drawn = 0;  ///< frames drawn, over all pages
  double latency_p50_s = 0.0;
  double latency_p99_s = 0.0;
  double latency_max_s = 0.0;
};

/// One thread of its own serves every client. A client gets the newest frame when it has credit
/// (FlowCredit), one message at a time. A client that stalls costs nothing but its socket, and is
/// let go when it answers no ping for half a minute.
class WebServer {
 public:
  /// Begins to listen. An occupied port is no error: the server takes the next free one, and logs
  /// a warning.
  /// @param mirror, pointers  outlive the server; their on_change() is taken over, and that of the
  /// topics
  /// @param execute    called from the server's thread with what a page wants of the simulation;
  ///                must not wait
  /// On an address beyond loopback a page may command only with the token in its address.
  /// @throws std::runtime_error when the address is not one of this machine, or is beyond loopback
  /// and the token is not usable
  WebServer(const ServerConfig& config, SceneMirror& mirror, PointerServer& pointers,
            std::function<void(const PageCommand&)> execute);

  /// Closes all connections and joins the thread.
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  const std::string& url() const noexcept;  ///< "http://127.0.0.1:8080"
  std::string command_url() const;          ///< url() with the token, if one is needed to command
  bool page_built() const noexcept;
  ServerFigures figures() const;  ///< any thread

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::viz
