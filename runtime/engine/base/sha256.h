/* Digests of bytes by SHA-256 (FIPS 180-4): base/sha256.c. */
#ifndef FUNICULAR_BASE_SHA256_H
#define FUNICULAR_BASE_SHA256_H

#include <stddef.h>

#define FU_DIGEST_BYTES 32

void fu_sha256(const unsigned char *bytes, size_t size, unsigned char digest[FU_DIGEST_BYTES]);

#endif
