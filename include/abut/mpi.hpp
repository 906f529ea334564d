// SPDX-License-Identifier: MIT
#pragma once

// Adds abut::distributed, queries on many processes. Needs MPI: link abut::mpi. In .cu files include <abut/cuda.hpp> as
// well.

#include <abut/abut.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/distance.hpp>
#include <abut/distributed/impacts.hpp>
#include <abut/distributed/parts.hpp>
#include <abut/distributed/query.hpp>
#include <abut/distributed/redistribute.hpp>
#include <abut/distributed/row_lists.hpp>
#include <abut/distributed/rows.hpp>
#include <abut/distributed/solids.hpp>
