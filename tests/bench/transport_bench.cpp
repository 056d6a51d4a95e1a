// tests/bench/transport_bench.cpp -- what DDS can carry the force loop over, one beside the other.
//
// usage: transport_bench [seconds of a run, 10]
// Two processes, as a device and a scene are: one writes a sample of the size of the force loop at
// 1 kHz, the other answers each in a thread of its own. Prints the delay from before the write until
// the answer is seen, and the processor time of a tick of both, polling apart; for each transport with
// the first polling for its answer and sleeping until it comes.
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "node/dds/arrival.h"
#include "node/dds/participant_ports.h"
#include "node/dds/udp_transport.h"
#include "node/inherited_priority.h"
#include "node/latency.h"
#include "node/paced_loop.h"
#include "node/processor_time.h"
#include "node/stop.h"
#include "node/time.h"
#include "tests/support/test_domain.h"

namespace {

namespace fast = eprosima::fastdds::dds;
namespace transport = eprosima::fastdds::rtps;
namespace rtps = eprosima::fastrtps::rtps;
using cordis::dds::Arrival;
using cordis::node::monotonic_nsec;

constexpr int kRate = 1000;                     // [Hz]
constexpr int kWarmUp = 500;                    // ticks that are not counted
constexpr std::int64_t kLongestPoll = 300'000;  // [ns]
constexpr int kLoopPriority = 80;
constexpr int kDdsPriority = 40;
constexpr int kPatience = 10 * kRate;  // ticks until the first answer

enum class Transport { kUdpOfLoop, kUdp, kSharedMemoryAndUdp, kSharedMemory, kDataSharing };

struct Named {
  Transport transport;
  const char* name;
};
constexpr Named kTransports[] = {{Transport::kUdpOfLoop, "UDP, as in use"},
                                 {Transport::kUdp, "UDP of Fast DDS"},
                                 {Transport::kSharedMemoryAndUdp, "shared memory and UDP"},
                                 {Transport::kSharedMemory, "shared memory"},
                                 {Transport::kDataSharing, "data sharing"}};

/// As many bytes as a message of the force loop has.
struct Sample {
  std::uint64_t number = 0;
  double values[24] = {};
};

/// It has no key, for data sharing refuses messages with a key.
class SampleType final : public fast::TopicDataType {
 public:
  SampleType() {
    setName("Sample");
    m_typeSize = kBytes;
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    std::memset(payload->data, 0, kHeaderBytes);
    payload->data[1] = CDR_LE;
    std::memcpy(payload->data + kHeaderBytes, data, sizeof(Sample));
    payload->length = kBytes;
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    if (payload->length < kBytes) return false;
    std::memcpy(data, payload->data + kHeaderBytes, sizeof(Sample));
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* /*data*/) override {
    return [] { return kBytes; };
  }
  void* createData() override { return new Sample; }
  void deleteData(void* data) override { delete static_cast<Sample*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
  bool is_bounded() const override { return true; }
  bool is_plain() const override { return true; }

 private:
  static constexpr std::uint32_t kHeaderBytes = 4;
  static constexpr std::uint32_t kBytes = kHeaderBytes + sizeof(Sample);
};

/// A participant whose loop takes the samples itself, as those of Cordis.
fast::DomainParticipantQos qos_of_loop(int domain, const cordis::dds::ParticipantPorts& ports,
                                       const std::shared_ptr<cordis::dds::TransportLink>& link) {
  fast::DomainParticipantQos qos;
  auto udp = std::make_shared<transport::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back("127.0.0.1");
  udp->sendBufferSize = udp->receiveBufferSize = 1u << 20;
  qos.transport().use_builtin_transports = false;
  cordis::dds::ParticipantConfig config{domain, "bench", "side"};
  config.for_loop = true;
  qos.transport().user_transports.push_back(
      std::make_shared<cordis::dds::UdpTransportDescriptor>(udp, config, ports.samples(), link));
  rtps::Locator_t samples(LOCATOR_KIND_UDPv4, ports.samples());
  rtps::IPLocator::setIPv4(samples, "127.0.0.1");
  qos.wire_protocol().default_unicast_locator_list.push_back(samples);
  return qos;
}

fast::DomainParticipantQos participant_qos(Transport kind) {
  fast::DomainParticipantQos qos;
  qos.transport().use_builtin_transports = false;
  if (kind != Transport::kUdp && kind != Transport::kDataSharing) {
    qos.transport().user_transports.push_back(
        std::make_shared<transport::SharedMemTransportDescriptor>());
  }
  if (kind != Transport::kSharedMemory) {
    auto udp = std::make_shared<transport::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.emplace_back("127.0.0.1");
    qos.transport().user_transports.push_back(udp);
  }
  return qos;
}

template <class Qos>
void apply(Transport kind, Qos& qos) {
  qos.reliability().kind = fast::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = fast::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 1;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_MEMORY_MODE;
  if (kind == Transport::kDataSharing) {
    qos.data_sharing().on("");
  } else {
    qos.data_sharing().off();
  }
}

/// One of the two processes: writes one topic, and takes the newest message of the other.
class Side final : public fast::DataReaderListener {
 public:
  /// Ends the process when DDS refuses.
  Side(Transport kind, int domain, const char* written, const char* read)
      : ports_(domain, "127.0.0.1") {
    const cordis::node::InheritedPriority priority(kDdsPriority);
    auto* const factory = fast::DomainParticipantFactory::get_instance();
    participant_ = factory->create_participant(
        static_cast<std::uint32_t>(domain),
        kind == Transport::kUdpOfLoop ? qos_of_loop(domain, ports_, link_) : participant_qos(kind));
    if (participant_ == nullptr) fail("a participant");
    link_->is_open = true;
    if (link_->samples != nullptr) {
      auto present = std::make_shared<cordis::dds::PresentSocket>();
      present->set(link_->samples);
      arrival_.attach(std::move(present));
    }
    const fast::TypeSupport type(new SampleType);
    type.register_type(participant_);
    const auto topic = [&](const char* name) {
      return participant_->create_topic(name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
    };
    fast::DataWriterQos writer_qos;
    apply(kind, writer_qos);
    writer_qos.publish_mode().kind = fast::SYNCHRONOUS_PUBLISH_MODE;
    writer_ = participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT)
                  ->create_datawriter(topic(written), writer_qos);
    fast::DataReaderQos reader_qos;
    apply(kind, reader_qos);
    reader_ =
        participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT)
            ->create_datareader(topic(read), reader_qos, this, fast::StatusMask::data_available());
    if (writer_ == nullptr || reader_ == nullptr) fail("a writer or a reader");
  }
  ~Side() override {
    participant_->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;

  void write(std::uint64_t number) {
    sample_.number = number;
    writer_->write(&sample_);
  }
  /// Number of the newest message; 0: none yet.
  std::uint64_t newest() const noexcept { return newest_.load(std::memory_order_acquire); }
  Arrival& arrival() noexcept { return arrival_; }

 private:
  static void fail(const char* what) {
    std::fprintf(stderr, "DDS refused %s\n", what);
    std::_Exit(1);
  }
  void on_data_available(fast::DataReader* available) override {
    fast::SampleInfo info;
    while (available->take_next_sample(&received_, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) newest_.store(received_.number, std::memory_order_release);
    }
    arrival_.announce();
  }

  cordis::dds::ParticipantPorts ports_;
  std::shared_ptr<cordis::dds::TransportLink> link_ =
      std::make_shared<cordis::dds::TransportLink>();
  fast::DomainParticipant* participant_ = nullptr;
  fast::DataWriter* writer_ = nullptr;
  fast::DataReader* reader_ = nullptr;
  Sample sample_;
  Sample received_;  // of the thread of DDS
  std::atomic<std::uint64_t> newest_{0};
  Arrival arrival_;
};

/// Answers until it is asked to end: a process that is killed leaves its shared memory behind.
void answer(Transport kind, int domain) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  cordis::node::install_stop_signals();
  Side side(kind, domain, "forces", "positions");
  cordis::node::make_realtime(kLoopPriority);
  std::uint64_t answered = 0;
  while (!cordis::node::stop_requested()) {
    const std::uint32_t seen = side.arrival().count();
    const std::uint64_t newest = side.newest();
    if (newest != answered) {
      answered = newest;
      side.write(answered);
    } else {
      side.arrival().wait_until(seen, monotonic_nsec() + 100'000'000);
    }
  }
}

/// Processor time of another process [ns].
std::int64_t processor_nsec(pid_t process) {
  clockid_t clock{};
  return clock_getcpuclockid(process, &clock) == 0 ? cordis::node::nsec_of_clock(clock) : 0;
}

/// Waits for the answer to a sample, at most half a period. @return when it was seen; 0: it was not
std::int64_t await(Side& side, std::uint64_t number, std::int64_t begun, std::int64_t poll_nsec,
                   std::int64_t& polled_nsec) {
  const std::int64_t end = begun + 500'000'000 / kRate;
  for (;;) {
    const std::uint32_t seen = side.arrival().count();
    const std::int64_t now = monotonic_nsec();
    if (side.newest() == number) return now;
    if (now >= end) return 0;
    if (now < begun + poll_nsec) {
      const std::int64_t before = side.arrival().polled_nsec();
      side.arrival().poll_until(seen, begun + poll_nsec);
      polled_nsec += side.arrival().polled_nsec() - before;
    } else {
      side.arrival().wait_until(seen, end);
    }
  }
}

/// Writes at 1 kHz and prints what it has measured. @return whether answers came
bool ask(const Named& named, int domain, bool polls, int seconds, pid_t answers) {
  Side side(named.transport, domain, "positions", "forces");
  cordis::node::make_realtime(kLoopPriority);
  cordis::node::PacedLoop pace(kRate);
  std::uint64_t number = 0;
  while (side.newest() == 0 && number < kPatience) {
    pace.wait();
    side.write(++number);
  }
  if (side.newest() == 0) return false;
  cordis::node::LatencyHistogram delays;
  std::int64_t polled = 0;
  std::int64_t own = 0;
  std::int64_t of_other = 0;
  int missed = 0;
  for (int tick = -kWarmUp; tick < seconds * kRate; ++tick) {
    if (tick == 0) {
      polled = 0;
      own = cordis::node::process_processor_nsec();
      of_other = processor_nsec(answers);
    }
    pace.wait();
    const std::int64_t begun = monotonic_nsec();
    side.write(++number);
    const std::int64_t seen = await(side, number, begun, polls ? kLongestPoll : 0, polled);
    if (tick < 0) continue;
    if (seen > 0) delays.record(seen - begun);
    missed += seen == 0;
  }
  own = cordis::node::process_processor_nsec() - own - polled;
  of_other = processor_nsec(answers) - of_other;
  const double per_tick = 1e-3 / (static_cast<double>(seconds) * kRate);  // [us]
  std::printf(
      "%-22s %-7s p50 %4.0f us  p99 %5.0f us  max %6.0f us  no answer in half a period %5.2f %%  "
      "processor per tick: device %5.1f us + %5.1f us polling, scene %5.1f us\n",
      named.name, polls ? "polls" : "sleeps", delays.quantile_nsec(0.5) * 1e-3,
      delays.quantile_nsec(0.99) * 1e-3, static_cast<double>(delays.largest_nsec()) * 1e-3,
      0.1 * missed / seconds, static_cast<double>(own) * per_tick,
      static_cast<double>(polled) * per_tick, static_cast<double>(of_other) * per_tick);
  std::fflush(stdout);
  return true;
}

/// One line of the table, measured by two processes of its own.
bool run(const Named& named, int domain, bool polls, int seconds) {
  const pid_t answers = fork();
  if (answers == 0) {
    answer(named.transport, domain);
    std::_Exit(0);
  }
  const pid_t asks = fork();
  if (asks == 0) std::_Exit(ask(named, domain, polls, seconds, answers) ? 0 : 1);
  int status = 0;
  waitpid(asks, &status, 0);
  kill(answers, SIGTERM);
  waitpid(answers, nullptr, 0);
  const bool is_measured = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!is_measured) std::printf("%-22s no answer came\n", named.name);
  return is_measured;
}

}  // namespace

int main(int argc, char** argv) {
  const int seconds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 10;
  const int domain = cordis::test::own_domain();
  bool all = true;
  for (const bool polls : {true, false}) {
    for (const Named& named : kTransports) all = run(named, domain, polls, seconds) && all;
  }
  return all ? 0 : 1;
}
