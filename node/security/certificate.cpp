// node/security/certificate.cpp
#include "node/security/certificate.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include "node/assert.h"
#include "node/config/open_file.h"
#include "node/session_key.h"

namespace cordis::node {
namespace {

namespace fs = std::filesystem;

template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* thing) const noexcept {
    Free(thing);
  }
};
using Bio = std::unique_ptr<BIO, Freed<BIO_free_all>>;
using Document = std::unique_ptr<PKCS7, Freed<PKCS7_free>>;
using Store = std::unique_ptr<X509_STORE, Freed<X509_STORE_free>>;

constexpr long kLargestFile = 1 << 20;  // bytes

void require(bool done, const char* what) {
  if (done) return;
  ERR_clear_error();
  throw std::runtime_error(std::string("OpenSSL refuses to ") + what);
}

/// @param text  outlives what is returned
Bio memory(const std::string& text) {
  Bio bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
  require(bio != nullptr, "read memory");
  return bio;
}

Bio memory() {
  Bio bio(BIO_new(BIO_s_mem()));
  require(bio != nullptr, "write memory");
  return bio;
}

std::string text_of(const Bio& bio) {
  char* text = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &text);
  return size > 0 ? std::string(text, static_cast<std::size_t>(size)) : std::string();
}

std::string entry(const X509* certificate, int kind) {
  const X509_NAME* const name = X509_get_subject_name(certificate);
  const int index = X509_NAME_get_index_by_NID(const_cast<X509_NAME*>(name), kind, -1);
  if (index < 0) return {};
  const ASN1_STRING* const text = X509_NAME_ENTRY_get_data(X509_NAME_get_entry(name, index));
  return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
          static_cast<std::size_t>(ASN1_STRING_length(text))};
}

std::time_t time_of(const ASN1_TIME* time) {
  std::tm parts{};
  require(ASN1_TIME_to_tm(time, &parts) == 1, "read a time");
  return timegm(&parts);
}

void add_entry(X509_NAME* name, const char* field, const std::string& value) {
  require(X509_NAME_add_entry_by_txt(name, field, MBSTRING_ASC,
                                     reinterpret_cast<const unsigned char*>(value.data()),
                                     static_cast<int>(value.size()), -1, 0) == 1,
          "name a certificate");
}

void add_extension(X509* certificate, int kind, const char* value) {
  std::unique_ptr<X509_EXTENSION, Freed<X509_EXTENSION_free>> extension(
      X509V3_EXT_conf_nid(nullptr, nullptr, kind, value));
  require(extension != nullptr && X509_add_ext(certificate, extension.get(), -1) == 1,
          "extend a certificate");
}

/// Whoever may sign permissions may do all: the certificate of a participant signs no documents, and
/// no authority signs what the other one does.
void add_extensions(X509* certificate, Certificate::Use use) {
  switch (use) {
    case Certificate::Use::kIdentityAuthority:
      add_extension(certificate, NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
      add_extension(certificate, NID_key_usage, "critical,keyCertSign");
      return;
    case Certificate::Use::kPermissionsAuthority:
      add_extension(certificate, NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
      add_extension(certificate, NID_key_usage, "critical,digitalSignature");
      add_extension(certificate, NID_ext_key_usage, "emailProtection");
      return;
    case Certificate::Use::kParticipant:
      add_extension(certificate, NID_basic_constraints, "critical,CA:FALSE");
      add_extension(certificate, NID_key_usage, "critical,digitalSignature,keyAgreement");
      add_extension(certificate, NID_ext_key_usage, "clientAuth");
      return;
  }
}

void number(X509* certificate) {
  unsigned char bytes[16];
  require(RAND_bytes(bytes, sizeof bytes) == 1, "give random numbers");
  bytes[0] &= 0x7f;
  std::unique_ptr<BIGNUM, Freed<BN_free>> serial(BN_bin2bn(bytes, sizeof bytes, nullptr));
  require(serial != nullptr &&
              BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(certificate)) != nullptr,
          "number a certificate");
}

/// @param is_private  others must not read it
std::string read_file(const fs::path& path, bool is_private) {
  const config::OpenFile file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number() < 0)
    refuse_security_file(path, std::string("cannot be read: ") + std::strerror(errno));
  struct stat found {};
  if (fstat(file.number(), &found) != 0 || !S_ISREG(found.st_mode))
    refuse_security_file(path, "is no file");
  if (is_private && found.st_uid != geteuid())
    refuse_security_file(path, "belongs to another user");
  if (is_private && (found.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    refuse_security_file(path, "is open to other users: chmod 600 closes it");
  if (found.st_size > kLargestFile) refuse_security_file(path, "is too large");
  std::string text(static_cast<std::size_t>(found.st_size), '\0');
  if (read(file.number(), text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    refuse_security_file(path, "cannot be read whole");
  return text;
}

}  // namespace

struct Certificate::Impl {
  std::unique_ptr<X509, void (*)(X509*)> certificate{nullptr, X509_free};
  std::unique_ptr<EVP_PKEY, void (*)(EVP_PKEY*)> key{nullptr, EVP_PKEY_free};
};

Certificate::Certificate(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Certificate::~Certificate() = default;
Certificate::Certificate(Certificate&&) noexcept = default;
Certificate& Certificate::operator=(Certificate&&) noexcept = default;

Certificate Certificate::make(const std::string& name, const std::string& unit, Use use,
                              const Validity& validity, const Certificate* issuer) {
  auto parts = std::make_unique<Impl>();
  parts->key.reset(EVP_EC_gen("P-256"));
  parts->certificate.reset(X509_new());
  X509* const certificate = parts->certificate.get();
  require(parts->key != nullptr && certificate != nullptr, "make a key");
  require(X509_set_version(certificate, X509_VERSION_3) == 1, "make a certificate");
  number(certificate);
  X509_NAME* const subject = X509_get_subject_name(certificate);
  // No two keys have one subject: the permissions of one would count for the other.
  add_entry(subject, "O", "Cordis " + SessionKey::random().digits());
  add_entry(subject, "OU", unit);
  add_entry(subject, "CN", name);
  const X509_NAME* const issuing =
      issuer == nullptr ? subject : X509_get_subject_name(issuer->impl_->certificate.get());
  require(X509_set_issuer_name(certificate, issuing) == 1 &&
              ASN1_TIME_set(X509_getm_notBefore(certificate), validity.from) != nullptr &&
              ASN1_TIME_set(X509_getm_notAfter(certificate), validity.until) != nullptr &&
              X509_set_pubkey(certificate, parts->key.get()) == 1,
          "make a certificate");
  add_extensions(certificate, use);
  EVP_PKEY* const signing = issuer == nullptr ? parts->key.get() : issuer->impl_->key.get();
  CORDIS_ASSERT(signing != nullptr);
  require(X509_sign(certificate, signing, EVP_sha256()) > 0, "sign a certificate");
  return Certificate(std::move(parts));
}

Certificate Certificate::read(const fs::path& file, const fs::path& key_file) {
  auto found = std::make_unique<Impl>();
  const std::string written = read_file(file, /*is_private=*/false);
  const Bio text = memory(written);
  found->certificate.reset(PEM_read_bio_X509(text.get(), nullptr, nullptr, nullptr));
  if (found->certificate == nullptr) refuse_security_file(file, "has no certificate");
  if (key_file.empty()) return Certificate(std::move(found));
  const std::string secret = read_private_file(key_file);
  const Bio key = memory(secret);
  char none[] = "";  // an encrypted key is refused: no password is asked for
  found->key.reset(PEM_read_bio_PrivateKey(key.get(), nullptr, nullptr, none));
  if (found->key == nullptr) refuse_security_file(key_file, "has no private key");
  if (X509_check_private_key(found->certificate.get(), found->key.get()) != 1)
    refuse_security_file(key_file, "does not belong to " + file.string());
  return Certificate(std::move(found));
}

std::string Certificate::unit() const {
  return entry(impl_->certificate.get(), NID_organizationalUnitName);
}

std::string Certificate::subject() const {
  const Bio text = memory();
  require(X509_NAME_print_ex(text.get(), X509_get_subject_name(impl_->certificate.get()), 0,
                             XN_FLAG_RFC2253 & ~ASN1_STRFLGS_ESC_MSB) >= 0,
          "print a name");
  return text_of(text);
}

std::time_t Certificate::from() const {
  return time_of(X509_get0_notBefore(impl_->certificate.get()));
}

std::time_t Certificate::until() const {
  return time_of(X509_get0_notAfter(impl_->certificate.get()));
}

bool Certificate::has_signed(const Certificate& other) const {
  EVP_PKEY* const key = X509_get0_pubkey(impl_->certificate.get());
  const bool is_signed = key != nullptr && X509_verify(other.impl_->certificate.get(), key) == 1;
  ERR_clear_error();
  return is_signed;
}

std::string Certificate::certificate_pem() const {
  const Bio text = memory();
  require(PEM_write_bio_X509(text.get(), impl_->certificate.get()) == 1, "write a certificate");
  return text_of(text);
}

std::string Certificate::key_pem() const {
  CORDIS_ASSERT(impl_->key != nullptr);
  const Bio text = memory();
  require(PEM_write_bio_PKCS8PrivateKey(text.get(), impl_->key.get(), nullptr, nullptr, 0, nullptr,
                                        nullptr) == 1,
          "write a key");
  return text_of(text);
}

std::string Certificate::signed_text(const std::string& text) const {
  CORDIS_ASSERT(impl_->key != nullptr);
  constexpr int kFlags = PKCS7_TEXT | PKCS7_DETACHED | PKCS7_STREAM;
  const Bio content = memory(text);
  const Document document(
      PKCS7_sign(impl_->certificate.get(), impl_->key.get(), nullptr, content.get(), kFlags));
  require(document != nullptr, "sign a document");
  const Bio written = memory();
  require(SMIME_write_PKCS7(written.get(), document.get(), content.get(), kFlags) == 1,
          "write a document");
  return text_of(written);
}

bool Certificate::has_signed_document(const std::string& document) const {
  const Bio text = memory(document);
  BIO* content = nullptr;
  const Document read(SMIME_read_PKCS7(text.get(), &content));
  const Bio owned(content);
  const Store store(X509_STORE_new());
  const Bio out = memory();
  const bool is_signed =
      read != nullptr && store != nullptr &&
      X509_STORE_add_cert(store.get(), impl_->certificate.get()) == 1 &&
      PKCS7_verify(read.get(), nullptr, store.get(), content, out.get(), PKCS7_TEXT) == 1;
  ERR_clear_error();
  return is_signed;
}

void refuse_security_file(const fs::path& file, const std::string& why) {
  ERR_clear_error();
  throw std::runtime_error("the key file " + file.string() + " " + why);
}

std::string read_private_file(const fs::path& file) {
  return read_file(file, /*is_private=*/true);
}

}  // namespace cordis::node
