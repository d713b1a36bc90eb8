// SPDX-License-Identifier: Apache-2.0
// A certificate for localhost that signs itself, made anew: none in the tree can expire.
#pragma once

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <cstdio>
#include <memory>
#include <string>

namespace lambent::test {

/// Writes a certificate and its key as PEM files; whether that worked.
inline bool write_certificate(const std::string& certificate, const std::string& key) {
  const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> pair(EVP_EC_gen("P-256"),
                                                                 EVP_PKEY_free);
  const std::unique_ptr<X509, decltype(&X509_free)> made(X509_new(), X509_free);
  if (!pair || !made) return false;
  constexpr long kDay = 86'400;  // [s]
  X509_set_version(made.get(), X509_VERSION_3);
  ASN1_INTEGER_set(X509_get_serialNumber(made.get()), 1);
  X509_gmtime_adj(X509_getm_notBefore(made.get()), -kDay);
  X509_gmtime_adj(X509_getm_notAfter(made.get()), kDay);
  X509_set_pubkey(made.get(), pair.get());
  X509_NAME* name = X509_get_subject_name(made.get());
  const auto* host = reinterpret_cast<const unsigned char*>("localhost");
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, host, -1, -1, 0);
  X509_set_issuer_name(made.get(), name);
  X509_EXTENSION* names =
      X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, "DNS:localhost");
  X509_add_ext(made.get(), names, -1);
  X509_EXTENSION_free(names);
  if (X509_sign(made.get(), pair.get(), EVP_sha256()) == 0) return false;

  std::FILE* to = std::fopen(certificate.c_str(), "w");
  bool done = to != nullptr && PEM_write_X509(to, made.get()) == 1;
  if (to != nullptr) std::fclose(to);
  to = std::fopen(key.c_str(), "w");
  done = done && to != nullptr &&
         PEM_write_PrivateKey(to, pair.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1;
  if (to != nullptr) std::fclose(to);
  return done;
}

}  // namespace lambent::test
