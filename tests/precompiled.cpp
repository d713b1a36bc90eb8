// SPDX-License-Identifier: Apache-2.0
// Nothing: precompiled headers must belong to a target, and targets have sources.
