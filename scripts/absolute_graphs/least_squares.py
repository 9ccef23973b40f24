"""Least squares over a pose graph with priors: Levenberg and Marquardt on sparse matrices."""

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

from graph import wrap


class Problem:
    """F = Σ eᵀ Ω e with e = t2v(Z⁻¹ Xᵢ⁻¹ Xₖ), priors with Xᵢ the identity."""

    def __init__(self, graph):
        ids = graph.ids()
        place = {name: k for k, name in enumerate(ids)}
        self.count = len(ids)
        self.i = np.array([place[e[0]] for e in graph.edges])
        self.k = np.array([place[e[1]] for e in graph.edges])
        self.z = np.array([e[2] for e in graph.edges])
        self.omega = np.array([e[3] for e in graph.edges])
        self.prior_of = np.array([place[p[0]] for p in graph.priors], dtype=int)
        self.a = np.array([p[1] for p in graph.priors]).reshape(-1, 3)
        self.prior_omega = np.array([p[2] for p in graph.priors]).reshape(-1, 3, 3)
        self.is_fixed = graph.fixed or not graph.priors

    def edge_terms(self, x):
        i, k = x[self.i], x[self.k]
        ci, si = np.cos(i[:, 2]), np.sin(i[:, 2])
        dx, dy = k[:, 0] - i[:, 0], k[:, 1] - i[:, 1]
        hx, hy = ci * dx + si * dy, -si * dx + ci * dy
        cz, sz = np.cos(self.z[:, 2]), np.sin(self.z[:, 2])
        ex, ey = hx - self.z[:, 0], hy - self.z[:, 1]
        e = np.stack([cz * ex + sz * ey, -sz * ex + cz * ey,
                      wrap(k[:, 2] - i[:, 2] - self.z[:, 2])], axis=1)
        Z = np.zeros((len(e), 3, 3))
        Z[:, 0, 0], Z[:, 0, 1], Z[:, 1, 0], Z[:, 1, 1], Z[:, 2, 2] = cz, sz, -sz, cz, 1.0
        A, B = np.zeros_like(Z), np.zeros_like(Z)
        B[:, 0, 0], B[:, 0, 1], B[:, 1, 0], B[:, 1, 1], B[:, 2, 2] = ci, si, -si, ci, 1.0
        A[:, :2, :2] = -B[:, :2, :2]
        A[:, 0, 2], A[:, 1, 2], A[:, 2, 2] = hy, -hx, -1.0
        return e, Z @ A, Z @ B

    def prior_terms(self, x):
        at = x[self.prior_of]
        c, s = np.cos(self.a[:, 2]), np.sin(self.a[:, 2])
        dx, dy = at[:, 0] - self.a[:, 0], at[:, 1] - self.a[:, 1]
        e = np.stack([c * dx + s * dy, -s * dx + c * dy, wrap(at[:, 2] - self.a[:, 2])], axis=1)
        J = np.zeros((len(e), 3, 3))
        J[:, 0, 0], J[:, 0, 1], J[:, 1, 0], J[:, 1, 1], J[:, 2, 2] = c, s, -s, c, 1.0
        return e, J

    def cost(self, x):
        e = self.edge_terms(x)[0]
        total = np.einsum("ni,nij,nj->", e, self.omega, e)
        if len(self.a):
            p = self.prior_terms(x)[0]
            total += np.einsum("ni,nij,nj->", p, self.prior_omega, p)
        return float(total)

    def normal_equations(self, x):
        e, A, B = self.edge_terms(x)
        rows, columns, values = [], [], []
        g = np.zeros((self.count, 3))

        def put(a, b, blocks):
            offset = np.arange(3)
            row = 3 * a[:, None, None] + offset[None, :, None]
            column = 3 * b[:, None, None] + offset[None, None, :]
            rows.append(np.broadcast_to(row, blocks.shape).ravel())
            columns.append(np.broadcast_to(column, blocks.shape).ravel())
            values.append(blocks.ravel())

        for a, Ja in ((self.i, A), (self.k, B)):
            left = np.swapaxes(Ja, 1, 2) @ self.omega
            np.add.at(g, a, np.einsum("nij,nj->ni", left, e))
            for b, Jb in ((self.i, A), (self.k, B)):
                put(a, b, left @ Jb)
        if len(self.a):
            p, J = self.prior_terms(x)
            left = np.swapaxes(J, 1, 2) @ self.prior_omega
            np.add.at(g, self.prior_of, np.einsum("nij,nj->ni", left, p))
            put(self.prior_of, self.prior_of, left @ J)
        size = 3 * self.count
        places = (np.concatenate(rows), np.concatenate(columns))
        H = scipy.sparse.coo_matrix((np.concatenate(values), places), shape=(size, size)).tocsc()
        first = 3 if self.is_fixed else 0
        return H[first:, first:], g.ravel()[first:], first

    def minimise(self, x, iterations=200):
        x = x.copy()
        cost, damping = self.cost(x), 1e-6
        for _ in range(iterations):
            H, g, first = self.normal_equations(x)
            scale = scipy.sparse.diags(damping * H.diagonal())
            step = np.zeros(3 * self.count)
            step[first:] = scipy.sparse.linalg.spsolve(H + scale, -g)
            moved = x + step.reshape(-1, 3)
            trial = self.cost(moved)
            if trial <= cost * (1.0 + 1e-14):
                x, damping = moved, max(damping / 10.0, 1e-15)
                is_settled = cost - trial < 1e-12 * max(cost, 1e-12) and np.abs(step).max() < 1e-7
                cost = trial
                if is_settled:
                    break
            else:
                damping = max(damping, 1e-12) * 10.0
                if damping > 1e12:
                    break
        return cost, x
