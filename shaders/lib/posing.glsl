// SPDX-License-Identifier: MIT
// Affine maps, and what morph targets and joints make of a vertex (glTF 2.0 specification, 3.7.2 and 3.7.3).

// The upper three rows of a matrix whose last row is 0 0 0 1.
struct Affine {
    vec4 x;
    vec4 y;
    vec4 z;
};

vec3 transformed(Affine m, vec3 p)
{
    vec4 h = vec4(p, 1.0f);
    return vec3(dot(m.x, h), dot(m.y, h), dot(m.z, h));
}

// By the cofactors, of any length: normals stay normal under uneven and mirrored scale.
vec3 transformedNormal(Affine m, vec3 n)
{
    vec3 x = vec3(m.x.x, m.x.y, m.x.z);
    vec3 y = vec3(m.y.x, m.y.y, m.y.z);
    vec3 z = vec3(m.z.x, m.z.y, m.z.z);
    return vec3(dot(cross(y, z), n), dot(cross(z, x), n), dot(cross(x, y), n));
}

// One more joint of linear blend skinning: the blended map is the sum of the joints' maps times their weights.
Affine withJoint(Affine sum, Affine joint, float weight)
{
    sum.x = sum.x + weight * joint.x;
    sum.y = sum.y + weight * joint.y;
    sum.z = sum.z + weight * joint.z;
    return sum;
}

// One more morph target.
vec3 withTarget(vec3 v, vec3 delta, float weight)
{
    return v + weight * delta;
}
